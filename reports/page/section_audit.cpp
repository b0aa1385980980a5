#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/html_table.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"
#include "reports/page/sections.h"
#include "reports/text/preparation_text.h"

namespace stiffscope::page {

namespace {

const char* meaningOf(AuditVerdict verdict) {
  switch (verdict) {
    case AuditVerdict::pass:
      return "The audit passes: the readings are fit to identify from.";
    case AuditVerdict::warn:
      return "The audit warns: the readings are fit to identify from, with what is said below.";
    case AuditVerdict::fail:
    case AuditVerdict::not_testable:
      break;
  }
  return "The audit fails: as they were read, the readings are not fit to identify from.";
}

std::string withUnit(const std::optional<double>& value, const std::string& unit) {
  if (!value) return "–";
  const bool whole = std::abs(*value) < 1e6 && *value == std::round(*value);
  return fmt::format("{}\u00a0{}", whole ? fixed(*value, 0) : significant(*value, 3), unit);
}

Row rowOf(const AuditCheck& check) {
  const std::string where = check.where.empty() ? "" : fmt::format(" ({})", check.where);
  const std::string source = check.limit_source.empty() ? "" : fmt::format("Limit: {}.", check.limit_source);
  return {auditName(check.id), auditWord(check.verdict), withUnit(check.value, check.unit),
          withUnit(check.limit, check.unit), Cell(check.message + where + ".", source)};
}

/// Worst first: a reader looks for what is wrong.
Table checksTable(const AuditReport& report) {
  Table table{"Checks",
              {"Check", "Verdict", "Found", "Limit", "What was found, and where the limit comes from"},
              {},
              true,
              "audit"};
  for (const AuditVerdict verdict :
       {AuditVerdict::fail, AuditVerdict::warn, AuditVerdict::pass, AuditVerdict::not_testable}) {
    RowGroup group;
    for (const AuditCheck& check : report.checks) {
      if (check.verdict == verdict) group.rows.push_back(rowOf(check));
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

void writeRejected(Html& html, const ReportCampaign& one) {
  const auto& rejected = one.audit->rejected;
  if (rejected.empty()) {
    html.paragraph("No reading was rejected.");
    return;
  }
  const bool raw = one.preparation != nullptr && one.preparation->raw;
  html.paragraph(fmt::format("{} reading{} rejected{}:", rejected.size(), rejected.size() == 1 ? "" : "s",
                             raw ? ", but used all the same, because raw readings were asked for"
                                 : " and left out of everything on this page"));
  std::vector<std::string> items;
  for (const RejectedReading& reading : rejected) items.push_back(rejectedWords(reading));
  html.list(items);
}

}  // namespace

void writeAudit(Html& html, const ReportContent& content) {
  const bool any = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                               [](const ReportCampaign& one) { return one.audit != nullptr; });
  if (!any) return;
  writeForEach(html, content, "audit", "Audit of the readings", [&](const ReportCampaign& one) {
    if (one.audit == nullptr) return;
    html.paragraph(meaningOf(one.audit->verdict));
    writeTable(html, checksTable(*one.audit));
    for (const AuditCheck& check : one.audit->checks) {
      if (check.details.empty()) continue;
      html.paragraph(fmt::format("{}, in detail:", auditName(check.id)));
      html.list(check.details);
    }
    writeRejected(html, one);
  });
}

}  // namespace stiffscope::page
