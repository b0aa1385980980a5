#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/audit/finding.h"
#include "reports/page/html_table.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"
#include "reports/page/sections.h"
#include "reports/page/with_micro.h"
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
  return fmt::format("{}\u00a0{}", whole ? fixed(*value, 0) : significant(*value, 3), withMicro(unit));
}

/// A limit's source without what holds for all that are by chance; that is said once.
std::string sourceOf(const AuditCheck& check) {
  const std::string common = byChance("");
  std::string source = check.limit_source;
  if (source.ends_with(common)) source.resize(source.size() - common.size());
  return withMicro(source);
}

bool anyByChance(const AuditReport& report) {
  return std::any_of(report.checks.begin(), report.checks.end(), [](const AuditCheck& check) {
    return check.limit_source.ends_with(byChance(""));
  });
}

Row findingRow(const AuditCheck& check) {
  const std::string where = check.where.empty() ? "" : fmt::format(" ({})", check.where);
  const std::string source = sourceOf(check);
  return {
      auditName(check.id), auditWord(check.verdict), withUnit(check.value, check.unit),
      withUnit(check.limit, check.unit),
      Cell(withMicro(check.message) + where + ".", source.empty() ? "" : fmt::format("Limit: {}.", source))};
}

/// Worst first: a reader looks for what is wrong.
Table findingsTable(const AuditReport& report) {
  Table table{"Findings",
              {"Check", "Verdict", "Found", "Limit", "What was found, and where the limit comes from"},
              {},
              true,
              "audit-findings"};
  for (const AuditVerdict verdict : {AuditVerdict::fail, AuditVerdict::warn}) {
    RowGroup group;
    for (const AuditCheck& check : report.checks) {
      if (check.verdict == verdict) group.rows.push_back(findingRow(check));
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

/// "100 to 300 deg" of checks that are made several times, axis by axis, against one limit.
std::string rangeOf(const std::vector<const AuditCheck*>& same) {
  const auto [least, most] =
      std::minmax_element(same.begin(), same.end(), [](const AuditCheck* a, const AuditCheck* b) {
        return a->value.value_or(0.0) < b->value.value_or(0.0);
      });
  const std::string low = withUnit((*least)->value, ""), high = withUnit((*most)->value, (*most)->unit);
  return same.size() == 1 ? high : fmt::format("{}to {}", low, high);
}

/// What passes, in a line each; checks of one name with one limit share it.
Table passedTable(const AuditReport& report) {
  Table table{"Checks that pass", {"Check", "Found", "Limit", "Limit by"}, {{}}, true, "audit-passed"};
  std::vector<std::vector<const AuditCheck*>> lines;
  for (const AuditCheck& check : report.checks) {
    if (check.verdict != AuditVerdict::pass) continue;
    const auto same = std::find_if(lines.begin(), lines.end(), [&check](const auto& line) {
      return line.front()->id == check.id && line.front()->limit == check.limit;
    });
    if (same == lines.end())
      lines.push_back({&check});
    else
      same->push_back(&check);
  }
  for (const auto& line : lines) {
    const AuditCheck& check = *line.front();
    table.groups.front().rows.push_back(
        {Cell(auditName(check.id), line.size() > 1 ? fmt::format("({} times)", line.size()) : std::string()),
         rangeOf(line), withUnit(check.limit, check.unit), sourceOf(check)});
  }
  return table;
}

/// Sentences on what has no verdict, and on what checks say besides it.
std::vector<std::string> furtherWords(const AuditReport& report, bool diagnosed) {
  std::vector<std::string> items;
  for (const AuditCheck& check : report.checks) {
    if (check.verdict == AuditVerdict::not_testable)
      items.push_back(fmt::format("{}, not testable: {}.", auditName(check.id), withMicro(check.message)));
    std::vector<std::string> details;
    for (const std::string& detail : check.details) {
      // Which effects could be told apart has a place of its own where there is a diagnosis.
      const bool told = diagnosed && detail.rfind("effects that", 0) == 0;
      if (!told) details.push_back(withMicro(detail));
    }
    if (!details.empty())
      items.push_back(fmt::format("{}: {}.", auditName(check.id), fmt::join(details, "; ")));
  }
  return items;
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
  for (const RejectedReading& reading : rejected) items.push_back(withMicro(rejectedWords(reading)));
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
    writeTable(html, findingsTable(*one.audit));
    writeTable(html, passedTable(*one.audit));
    html.list(furtherWords(*one.audit, one.diagnosis != nullptr && one.diagnosis->usable));
    if (anyByChance(*one.audit)) {
      html.paragraph(
          "Limits by chi-square, normal deviates or Student's t share 1\u00a0% of false findings over the "
          "whole audit.",
          "faint");
    }
    writeRejected(html, one);
  });
}

}  // namespace stiffscope::page
