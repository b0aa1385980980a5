#include "reports/page/pages.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "reports/json/json_document.h"
#include "reports/page/embedded.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/page/style.h"
#include "reports/report_content.h"

namespace stiffscope::page {

namespace {

void writeHead(Html& html, const reports::ReportContent& content) {
  const auto head = html.element("head");
  html.voidElement("meta", {{"charset", "utf-8"}});
  html.voidElement("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.voidElement("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.leaf("title", reports::plain(content.title));
  html.style(pageStyle(reports::reportId(content)));
}

/// A section of the page with its entry in the contents.
struct Section {
  const char* id;
  const char* entry;
  void (*write)(Html& html, const reports::ReportContent& content);
  bool shown;
};

/// In the order of the page; what a report's days do not have is not shown.
std::vector<Section> sectionsOf(const reports::ReportContent& content) {
  const auto any = [&content](const auto& about) {
    return std::any_of(content.campaigns.begin(), content.campaigns.end(), about);
  };
  // Without a load case there is no spread and nothing to compensate; the stiffnesses' section says why.
  const bool loads = any([](const reports::ReportCampaign& one) { return !one.identification.cases.empty(); });
  const bool improved = any([](const reports::ReportCampaign& one) { return one.improved != nullptr; });
  const bool diagnosed = any([](const reports::ReportCampaign& one) { return one.diagnosis != nullptr; });
  const bool calibrated = any(isCalibrated);
  return {{"conditions", "Conditions", writeConditions, true},
          {"accuracy", "Accuracy", writeAccuracy, calibrated},
          {"parameters", "Parameters", writeParameters, calibrated},
          {"station", "Station", writeStation, any(hasStation)},
          {"accuracy-gap", "What the geometry misses", writeAccuracyGap, calibrated},
          {"next", "What to do next", writeNextSteps, any(hasActions)},
          {"wrist", "Wrist centre", writeWrist, any(hasWrist)},
          {"links", "Links", writeLinks, any(hasAxes)},
          {"stiffness", "Stiffness", writeStiffness, any(isLoaded)},
          {"transmission", "Gears", writeTransmission, anySecondEncoders(content)},
          {"subsets", "Spread", writeSubsets, loads},
          {"workspace", "Stiffness over the workspace", writeWorkspace, any(hasWorkspace)},
          {"compensation", "Compensation", writeCompensation, loads},
          {"effects", "Effects in the model", writeExtendedModel, improved},
          {"gap", "What the model misses", writeGap, diagnosed},
          {"figures", "Figures", writeFigures, hasFigures(content, "figures")},
          {"audit", "Audit", writeAudit, any(isAudited)},
          {"left-out", "Left out", writeLeftOut, any(hasLeftOut)},
          {"scope", "Uncertainty and scope", writeScope, true},
          {"provenance", "Inputs", writeProvenance, true},
          {"versions", "How this page was made", writeVersions, hasVersions(content)}};
}

std::vector<Html::Section> shownOf(const std::vector<Section>& sections) {
  std::vector<Html::Section> shown;
  for (const Section& section : sections)
    if (section.shown) shown.push_back({section.id, section.entry});
  return shown;
}

/// JSON in a script: nothing in it is markup to HTML or XML, and JSON reads the same.
std::string withoutMarkup(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<' || c == '>' || c == '&')
      text += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      text += c;
  }
  return text;
}

/// What charts.js lays over a figure; of very many marks every so many, which lie on each other anyway.
std::string marksJson(const reports::Figure& figure) {
  constexpr std::size_t kMostMarks = 3000;
  const std::size_t every = (figure.marks.size() + kMostMarks - 1) / kMostMarks;
  std::vector<std::string> series, categories, quantities;
  const auto indexOf = [](std::vector<std::string>& names, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<int>(found - names.begin());
    names.push_back(name);
    return static_cast<int>(names.size()) - 1;
  };
  const auto rounded = [](double value, double digits) { return std::round(value * digits) / digits; };
  reports::Json marks = reports::Json::array();
  for (std::size_t i = 0; i < figure.marks.size(); i += every) {
    const reports::FigureMark& mark = figure.marks[i];
    const double digits = std::pow(10.0, 5.0 - std::ceil(std::log10(std::max(std::abs(mark.value), 1e-12))));
    marks.push_back({rounded(mark.x, 1e4), rounded(mark.y, 1e4), indexOf(series, mark.series),
                     mark.category.empty() ? -1 : indexOf(categories, mark.category), rounded(mark.value, digits),
                     rounded(mark.at, 1e4), indexOf(quantities, mark.quantity)});
  }
  return reports::Json{{"quantities", quantities},
                       {"category", figure.category_name},
                       {"series", series},
                       {"categories", categories},
                       {"marks", std::move(marks)}}
      .dump(-1, ' ', false, reports::Json::error_handler_t::replace);
}

/// The values of a figure as a file beside the page; `quantity` is the title of the value's axis, which has the unit.
void keepMarks(Html& html, const reports::Figure& figure) {
  if (figure.marks.empty()) return;
  reports::DataTable data{{"series", "category", "at", "value", "quantity"}, {}};
  for (const reports::FigureMark& mark : figure.marks)
    data.rows.push_back({reports::plain(mark.series), reports::plain(mark.category),
                         mark.category.empty() ? reports::DataCell(mark.at) : reports::DataCell(), mark.value,
                         reports::plain(mark.quantity)});
  html.keepTable("figure-" + figure.id, reports::csvTable(data));
}

void writeScripts(Html& html, const reports::ReportContent& content) {
  writeChartScripts(html, content.figures);
  if (content.scenes.empty() || kThreeGzip.empty()) return;
  for (const reports::PageScene& scene : content.scenes)
    html.script(withoutMarkup(scene.json),
                {{"type", "application/json"}, {"class", "scene"}, {"data-figure", scene.figure}});
  const std::vector<std::uint8_t> three(kThreeGzip.begin(), kThreeGzip.end());
  html.script(base64(three), {{"type", "text/plain"}, {"id", "three"}});
  html.script(kSceneScript);
}

void writeEnd(Html& html, const reports::ReportContent& content) {
  const auto footer = html.element("footer");
  html.paragraph(fmt::format("End of report {}.", reports::reportId(content)), "faint");
}

}  // namespace

void writeChartScripts(Html& html, const std::vector<reports::Figure>& figures) {
  html.script(kTablesScript);
  bool any = false;
  for (const reports::Figure& figure : figures) {
    if (figure.marks.empty()) continue;
    any = true;
    html.script(withoutMarkup(marksJson(figure)),
                {{"type", "application/json"}, {"class", "marks"}, {"data-figure", figure.id}});
  }
  if (any) html.script(kChartsScript);
}

ReportPage makeReportPage(const reports::ReportContent& content) {
  Html html;
  {
    const auto root = html.element("html", {{"lang", "en"}});
    writeHead(html, content);
    const auto body = html.element("body");
    html.leaf("a", "To the results", {{"class", "skip"}, {"href", "#results"}});
    const std::vector<Section> sections = sectionsOf(content);
    html.setSections(shownOf(sections));
    writeContents(html, shownOf(sections));
    writeOpening(html, content);
    const auto main = html.element("main", {{"id", "results"}, {"tabindex", "-1"}});
    for (const Section& section : sections) {
      if (section.shown) section.write(html, content);
    }
    writeEnd(html, content);
    for (const reports::Figure& figure : content.figures) keepMarks(html, figure);
    writeScripts(html, content);
  }
  return {html.bytes(), html.tables()};
}

std::string reportPage(const reports::ReportContent& content) { return makeReportPage(content).html; }

}  // namespace stiffscope::page
