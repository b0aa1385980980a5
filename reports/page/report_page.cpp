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

/// Without a load case there is no spread and nothing to compensate; the stiffnesses' section says why.
bool anyLoads(const reports::ReportContent& content) {
  return std::any_of(content.campaigns.begin(), content.campaigns.end(),
                     [](const reports::ReportCampaign& one) { return !one.identification.cases.empty(); });
}

void writeContents(Html& html, const reports::ReportContent& content) {
  const auto nav = html.element("nav", {{"aria-label", "Contents"}});
  const auto list = html.element("ul");
  const auto entry = [&html](const char* id, const char* name) {
    const auto item = html.element("li");
    html.leaf("a", name, {{"href", std::string("#") + id}});
  };
  entry("conditions", "Conditions");
  entry("wrist", "Wrist centre");
  entry("links", "Links");
  entry("stiffness", "Stiffness");
  if (anySecondEncoders(content)) entry("transmission", "Gears");
  if (anyLoads(content)) entry("subsets", "Spread");
  if (anyLoads(content)) entry("compensation", "Compensation");
  const bool improved = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                                    [](const reports::ReportCampaign& one) { return one.improved != nullptr; });
  if (improved) entry("effects", "Effects in the model");
  const bool diagnosed = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                                     [](const reports::ReportCampaign& one) { return one.diagnosis != nullptr; });
  if (diagnosed) entry("gap", "What the model misses");
  if (hasFigures(content, "figures")) entry("figures", "Figures");
  const bool audited = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                                   [](const reports::ReportCampaign& one) { return one.audit != nullptr; });
  if (audited) entry("audit", "Audit");
  entry("left-out", "Left out");
  entry("scope", "Uncertainty and scope");
  entry("provenance", "Inputs");
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
    writeContents(html, content);
    const auto main = html.element("main", {{"id", "results"}, {"tabindex", "-1"}});
    writeConditions(html, content);
    writeWrist(html, content);
    writeLinks(html, content);
    writeStiffness(html, content);
    writeTransmission(html, content);
    if (anyLoads(content)) writeSubsets(html, content);
    if (anyLoads(content)) writeCompensation(html, content);
    writeExtendedModel(html, content);
    writeGap(html, content);
    writeFigures(html, content);
    writeAudit(html, content);
    writeLeftOut(html, content);
    writeScope(html, content);
    writeProvenance(html, content);
    writeEnd(html, content);
    html.leaf("script", kSortScript);
  }
  return {html.bytes(), html.tables()};
}

std::string reportPage(const reports::ReportContent& content) { return makeReportPage(content).html; }

}  // namespace stiffscope::page
