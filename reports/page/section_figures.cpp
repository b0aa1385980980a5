#include "reports/page/base64.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

void writeFigures(Html& html, const ReportContent& content) {
  if (content.figures.empty()) return;
  const auto section = html.element("section", {{"id", "figures"}});
  html.leaf("h2", "Figures");
  for (const Figure& figure : content.figures) {
    const auto element = html.element("figure", {{"id", figure.id}});
    html.voidElement("img", {{"src", "data:image/png;base64," + base64(figure.png)},
                             {"alt", figure.alt},
                             {"width", std::to_string(figure.width)},
                             {"height", std::to_string(figure.height)}});
    const auto caption = html.element("figcaption");
    html.leaf("b", figure.title + ".");
    html.text(" ");
    html.rich(figure.caption);
  }
}

}  // namespace stiffscope::page
