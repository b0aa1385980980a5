#include "reports/page/report_page.h"

#include <fmt/format.h>
#include <algorithm>

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
  html.leaf("style", pageStyle(reports::reportId(content)));
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
          {"provenance", "Inputs", writeProvenance, true}};
}

void writeContents(Html& html, const std::vector<Section>& sections) {
  const auto nav = html.element("nav", {{"aria-label", "Contents"}});
  const auto list = html.element("ul");
  for (const Section& section : sections) {
    if (!section.shown) continue;
    const auto item = html.element("li");
    html.leaf("a", section.entry, {{"href", std::string("#") + section.id}});
  }
}

void writeEnd(Html& html, const reports::ReportContent& content) {
  const auto footer = html.element("footer");
  html.paragraph(fmt::format("End of report {}.", reports::reportId(content)), "faint");
}

}  // namespace

ReportPage makeReportPage(const reports::ReportContent& content) {
  Html html;
  {
    const auto root = html.element("html", {{"lang", "en"}});
    writeHead(html, content);
    const auto body = html.element("body");
    html.leaf("a", "To the results", {{"class", "skip"}, {"href", "#results"}});
    writeOpening(html, content);
    const std::vector<Section> sections = sectionsOf(content);
    writeContents(html, sections);
    const auto main = html.element("main", {{"id", "results"}, {"tabindex", "-1"}});
    for (const Section& section : sections) {
      if (section.shown) section.write(html, content);
    }
    writeEnd(html, content);
    html.leaf("script", kSortScript);
  }
  return {html.bytes(), html.tables()};
}

std::string reportPage(const reports::ReportContent& content) { return makeReportPage(content).html; }

}  // namespace stiffscope::page
