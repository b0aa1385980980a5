#include "reports/page/pages.h"

#include <stdexcept>

#include "reports/page/embedded.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/page/style.h"
#include "reports/words/stated_comparison_words.h"

namespace stiffscope::page {

namespace {

constexpr const char* kUnmatched = "Postures that are not compared";

const char* headingOf(const std::string& table) {
  if (table == "stiffness") return "Stiffness";
  if (table == "postures") return "Deflection and residuals";
  if (table == "accuracy") return "Accuracy";
  if (table == "gap") return "What the model misses";
  if (table == "links") return "Geometry";
  return "What was compared";
}

void writeComparisonHead(Html& html, const std::string& title) {
  const auto head = html.element("head");
  html.voidElement("meta", {{"charset", "utf-8"}});
  html.voidElement("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.voidElement("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.leaf("title", title);
  html.style(pageStyle("of a comparison"));
}

}  // namespace

std::string comparisonPage(const reports::StatedComparison& comparison, const std::vector<reports::Figure>& figures) {
  if (!comparison.refused.empty()) throw std::invalid_argument(comparison.refused);
  reports::ReportContent content;
  content.figures = figures;
  const std::vector<reports::Table> tables = reports::statedTables(comparison);
  Html html;
  {
    const auto root = html.element("html", {{"lang", "en"}});
    writeComparisonHead(html, "Two results of " + comparison.before.robot);
    const auto body = html.element("body");
    html.leaf("a", "To the results", {{"class", "skip"}, {"href", "#results"}});
    std::vector<Html::Section> sections;
    for (const reports::Table& table : tables) sections.push_back({table.id, headingOf(table.id)});
    if (!comparison.unmatched.empty()) sections.push_back({"unmatched", kUnmatched});
    writeContents(html, sections);
    {
      const auto header = html.element("header");
      html.leaf("h1", "Two results of " + reports::asIs(comparison.before.robot));
      html.paragraph(reports::changedWords(comparison), "verdict");
      html.list(reports::saidOfBoth(comparison));
      if (!comparison.cautions.empty()) {
        const auto cautions = html.element("div", {{"class", "cautions"}});
        html.leaf("h3", "Before believing it");
        std::vector<std::string> rich;
        for (const std::string& caution : comparison.cautions) rich.push_back(caution);
        html.list(rich);
      }
    }
    const auto main = html.element("main", {{"id", "results"}, {"tabindex", "-1"}});
    for (const reports::Table& table : tables) {
      const auto section = html.element("section", {{"id", table.id}});
      html.leaf("h2", headingOf(table.id));
      writeTable(html, table);
      writeFiguresOf(html, content, table.id);
    }
    if (!comparison.unmatched.empty()) {
      const auto section = html.element("section", {{"id", "unmatched"}});
      html.leaf("h2", kUnmatched);
      std::vector<std::string> all;
      for (const std::string& one : comparison.unmatched) all.push_back(reports::asIs(one));
      html.list(all);
    }
    const auto footer = html.element("footer");
    html.paragraph("End of the comparison.", "faint");
    writeChartScripts(html, figures);
  }
  return html.bytes();
}

}  // namespace stiffscope::page
