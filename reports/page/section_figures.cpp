#include <fmt/format.h>

#include <algorithm>

#include "reports/page/base64.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

namespace {

void writeFigure(Html& html, const Figure& figure, int number) {
  const auto element = html.element("figure", {{"id", figure.id}});
  html.voidElement("img", {{"src", "data:image/png;base64," + base64(figure.png)},
                           {"alt", figure.alt},
                           {"width", std::to_string(figure.width)},
                           {"height", std::to_string(figure.height)}});
  const auto caption = html.element("figcaption");
  html.leaf("b", fmt::format("Figure {}. {}.", number, figure.title));
  html.text(" ");
  html.rich(figure.caption);
}

}  // namespace

bool hasFigures(const ReportContent& content, const std::string& section) {
  return std::any_of(content.figures.begin(), content.figures.end(),
                     [&](const Figure& figure) { return figure.section == section; });
}

void writeFiguresOf(Html& html, const ReportContent& content, const std::string& section) {
  if (!hasFigures(content, section)) return;
  int number = 0;
  for (const char* earlier : kFigureSections) {
    if (section == earlier) break;
    number +=
        static_cast<int>(std::count_if(content.figures.begin(), content.figures.end(),
                                       [&](const Figure& figure) { return figure.section == earlier; }));
  }
  const auto grid = html.element("div", {{"class", "figures"}});
  for (const Figure& figure : content.figures) {
    if (figure.section == section) writeFigure(html, figure, ++number);
  }
}

void writeFigures(Html& html, const ReportContent& content) {
  if (!hasFigures(content, "figures")) return;
  const auto section = html.element("section", {{"id", "figures"}});
  html.leaf("h2", "Figures");
  writeFiguresOf(html, content, "figures");
}

}  // namespace stiffscope::page
