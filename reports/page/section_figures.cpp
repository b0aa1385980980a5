#include <fmt/format.h>

#include "reports/page/base64.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

void writeFigures(Html& html, const ReportContent& content) {
  if (content.figures.empty()) return;
  const auto section = html.element("section", {{"id", "figures"}});
  html.leaf("h2", "Figures");
  const auto grid = html.element("div", {{"class", "figures"}});
  for (std::size_t i = 0; i < content.figures.size(); ++i) {
    const Figure& figure = content.figures[i];
    const auto element = html.element("figure", {{"id", figure.id}});
    html.voidElement("img", {{"src", "data:image/png;base64," + base64(figure.png)},
                             {"alt", figure.alt},
                             {"width", std::to_string(figure.width)},
                             {"height", std::to_string(figure.height)}});
    const auto caption = html.element("figcaption");
    html.leaf("b", fmt::format("Figure {}. {}.", i + 1, figure.title));
    html.text(" ");
    html.rich(figure.caption);
  }
}

}  // namespace stiffscope::page
