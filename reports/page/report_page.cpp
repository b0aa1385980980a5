#include "reports/page/report_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "reports/page/html.h"
#include "reports/page/report_id.h"
#include "reports/page/sections.h"
#include "reports/page/sort_script.h"
#include "reports/page/style.h"

namespace stiffscope {

namespace {

void writeHead(page::Html& html, const ReportContent& content) {
  const auto head = html.element("head");
  html.voidElement("meta", {{"charset", "utf-8"}});
  html.voidElement("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.voidElement("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.leaf("title", page::plain(content.title));
  html.leaf("style", page::pageStyle(reportId(content)));
}

/// Without a load case there is no spread and nothing to compensate; the stiffnesses' section says why.
bool anyLoads(const ReportContent& content) {
  return std::any_of(content.campaigns.begin(), content.campaigns.end(),
                     [](const ReportCampaign& one) { return !one.identification.cases.empty(); });
}

void writeContents(page::Html& html, const ReportContent& content) {
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
  if (anyLoads(content)) entry("subsets", "Spread");
  if (anyLoads(content)) entry("compensation", "Compensation");
  const bool improved = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                                    [](const ReportCampaign& one) { return one.improved != nullptr; });
  if (improved) entry("effects", "Effects in the model");
  const bool diagnosed = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                                     [](const ReportCampaign& one) { return one.diagnosis != nullptr; });
  if (diagnosed) entry("gap", "What the model misses");
  if (page::hasFigures(content, "figures")) entry("figures", "Figures");
  const bool audited = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                                   [](const ReportCampaign& one) { return one.audit != nullptr; });
  if (audited) entry("audit", "Audit");
  entry("left-out", "Left out");
  entry("scope", "Uncertainty and scope");
  entry("provenance", "Inputs");
}

void writeEnd(page::Html& html, const ReportContent& content) {
  const auto footer = html.element("footer");
  html.paragraph(fmt::format("End of report {}.", reportId(content)), "faint");
}

}  // namespace

ReportPage makeReportPage(const ReportContent& content) {
  page::Html html;
  {
    const auto root = html.element("html", {{"lang", "en"}});
    writeHead(html, content);
    const auto body = html.element("body");
    html.leaf("a", "To the results", {{"class", "skip"}, {"href", "#results"}});
    page::writeOpening(html, content);
    writeContents(html, content);
    const auto main = html.element("main", {{"id", "results"}, {"tabindex", "-1"}});
    page::writeConditions(html, content);
    page::writeWrist(html, content);
    page::writeLinks(html, content);
    page::writeStiffness(html, content);
    if (anyLoads(content)) page::writeSubsets(html, content);
    if (anyLoads(content)) page::writeCompensation(html, content);
    page::writeImproved(html, content);
    page::writeGap(html, content);
    page::writeFigures(html, content);
    page::writeAudit(html, content);
    page::writeLeftOut(html, content);
    page::writeScope(html, content);
    page::writeProvenance(html, content);
    writeEnd(html, content);
    html.leaf("script", page::kSortScript);
  }
  return {html.bytes(), html.tables()};
}

std::string reportPage(const ReportContent& content) { return makeReportPage(content).html; }

}  // namespace stiffscope
