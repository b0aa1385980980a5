#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/audit/remarks.h"
#include "core/preparation/finding.h"
#include "reports/json/json.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/words/audit_figures.h"
#include "reports/words/conformity_words.h"
#include "reports/words/day_words.h"
#include "reports/words/listed.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::page {

namespace {

std::string withUnit(const std::optional<double>& value, const std::string& unit) {
  if (!value) return "–";
  const bool whole = std::abs(*value) < 1e6 && *value == std::round(*value);
  return fmt::format("{}\u00a0{}", whole ? reports::fixed(*value, 0) : reports::significant(*value, 3),
                     reports::withMicro(unit));
}

/// "at most 1.26 of noise sd", "at least 90 deg".
std::string limitWords(const reports::AuditFigures& figures) {
  if (!figures.limit) return "–";
  return (figures.least ? "at least " : "at most ") + withUnit(figures.limit, figures.unit);
}

/// A limit's source without what holds for all that are by chance; that is said once.
std::string sourceOf(const preparation::AuditCheck& check) {
  constexpr std::string_view kCommon = reports::kChanceIsShared;
  std::string source = reports::words(check.limit_source);
  if (source.ends_with(kCommon)) source.resize(source.size() - kCommon.size());
  return reports::withMicro(source);
}

bool anyByChance(const audit::AuditReport& report) {
  return std::any_of(report.checks.begin(), report.checks.end(), [](const preparation::AuditCheck& check) {
    return reports::words(check.limit_source).ends_with(reports::kChanceIsShared);
  });
}

reports::Row findingRow(const preparation::AuditCheck& check) {
  const std::string where = check.where.empty() ? "" : fmt::format(" ({})", reports::words(check.where));
  const std::string source = sourceOf(check);
  const reports::AuditFigures figures = reports::figuresOf(check);
  return {reports::auditName(check.id), reports::auditWord(check.verdict), withUnit(figures.value, figures.unit),
          limitWords(figures),
          reports::Cell(reports::withMicro(reports::words(check.message)) + where + ".",
                        source.empty() ? "" : fmt::format("Limit: {}.", source))};
}

/// A row a check, by its id.
reports::DataTable checksData(const audit::AuditReport& report,
                              const std::vector<preparation::AuditVerdict>& verdicts) {
  reports::DataTable data{{"check", "verdict", "value", "limit", "unit", "where", "message", "limit_by"}, {}};
  for (const preparation::AuditVerdict verdict : verdicts) {
    for (const preparation::AuditCheck& check : report.checks) {
      if (check.verdict != verdict) continue;
      const reports::AuditFigures figures = reports::figuresOf(check);
      data.rows.push_back({std::string(check.id), std::string(reports::nameOf(check.verdict)),
                           figures.value ? reports::DataCell(*figures.value) : reports::DataCell(),
                           figures.limit ? reports::DataCell(*figures.limit) : reports::DataCell(), figures.unit,
                           reports::words(check.where), reports::words(check.message),
                           reports::words(check.limit_source)});
    }
  }
  return data;
}

/// Worst first: a reader looks for what is wrong.
reports::Table findingsTable(const audit::AuditReport& report) {
  reports::Table table{"Findings",
                       {"Check", "Verdict", "Found", "Limit", "What was found, and where the limit comes from"},
                       {},
                       true,
                       "audit-findings"};
  table.data = checksData(report, {preparation::AuditVerdict::fail, preparation::AuditVerdict::warn});
  for (const preparation::AuditVerdict verdict : {preparation::AuditVerdict::fail, preparation::AuditVerdict::warn}) {
    reports::RowGroup group;
    for (const preparation::AuditCheck& check : report.checks) {
      if (check.verdict == verdict) group.rows.push_back(findingRow(check));
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

/// "100 to 300 deg" of checks that are made several times, axis by axis, against one limit.
std::string rangeOf(const std::vector<const preparation::AuditCheck*>& same) {
  const auto [least, most] = std::minmax_element(
      same.begin(), same.end(), [](const preparation::AuditCheck* a, const preparation::AuditCheck* b) {
        return a->value.value_or(0.0) < b->value.value_or(0.0);
      });
  const reports::AuditFigures of_most = reports::figuresOf(**most);
  const std::string low = withUnit(reports::figuresOf(**least).value, ""), high = withUnit(of_most.value, of_most.unit);
  return same.size() == 1 ? high : fmt::format("{}to {}", low, high);
}

/// What passes, in a line each; checks of one name with one limit share it.
reports::Table passedTable(const audit::AuditReport& report) {
  reports::Table table{"Checks that pass", {"Check", "Found", "Limit", "Limit by"}, {{}}, true, "audit-passed"};
  table.data = checksData(report, {preparation::AuditVerdict::pass});
  std::vector<std::vector<const preparation::AuditCheck*>> lines;
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.verdict != preparation::AuditVerdict::pass) continue;
    const auto same = std::find_if(lines.begin(), lines.end(), [&check](const auto& line) {
      return line.front()->id == check.id && line.front()->limit == check.limit;
    });
    if (same == lines.end())
      lines.push_back({&check});
    else
      same->push_back(&check);
  }
  for (const auto& line : lines) {
    const preparation::AuditCheck& check = *line.front();
    const reports::AuditFigures figures = reports::figuresOf(check);
    table.groups.front().rows.push_back(
        {reports::Cell(reports::auditName(check.id),
                       line.size() > 1 ? fmt::format("({} times)", line.size()) : std::string()),
         rangeOf(line), limitWords(figures), sourceOf(check)});
  }
  return table;
}

bool isOnEffects(const Remark& detail) {
  return detail.is(audit::RemarkId::effects_apart) || detail.is(audit::RemarkId::effects_alike) ||
         detail.is(audit::RemarkId::effects_not_testable);
}

/// What a check that is not testable says, of several axes at once where it says the same of them: "axes 1, 2, 3: it
/// was not swept" instead of a line each.
std::vector<std::string> untestableWords(const audit::AuditReport& report) {
  struct Said {
    std::string name, what;
    std::vector<std::string> axes;
  };
  std::vector<Said> all;
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.verdict != preparation::AuditVerdict::not_testable) continue;
    Said said{reports::auditName(check.id), reports::withMicro(reports::words(check.message)), {}};
    const std::string axis = check.where.empty() ? std::string() : reports::words(check.where);
    constexpr std::string_view kAxis = "axis ";
    if (axis.starts_with(kAxis) && said.what.starts_with(axis + ": ")) {
      said.what.erase(0, axis.size() + 2);
      said.axes.push_back(axis.substr(kAxis.size()));
    }
    const auto same = std::find_if(all.begin(), all.end(), [&said](const Said& one) {
      return one.name == said.name && one.what == said.what && !one.axes.empty() && !said.axes.empty();
    });
    if (same == all.end())
      all.push_back(std::move(said));
    else
      same->axes.push_back(said.axes.front());
  }
  std::vector<std::string> items;
  for (const Said& one : all) {
    const std::string of =
        one.axes.empty() ? "" : fmt::format("ax{} {}: ", one.axes.size() == 1 ? "is" : "es", fmt::join(one.axes, ", "));
    items.push_back(fmt::format("{}, not testable: {}{}.", one.name, of, one.what));
  }
  return items;
}

/// Sentences on what has no verdict, and on what checks say besides it.
std::vector<std::string> furtherWords(const audit::AuditReport& report, bool diagnosed) {
  std::vector<std::string> items = untestableWords(report);
  for (const preparation::AuditCheck& check : report.checks) {
    std::vector<std::string> details;
    for (const Remark& detail : check.details) {
      // Which effects could be told apart has a place of its own where there is a diagnosis.
      if (!diagnosed || !isOnEffects(detail)) details.push_back(reports::withMicro(reports::words(detail)));
    }
    if (!details.empty())
      items.push_back(fmt::format("{}: {}.", reports::auditName(check.id), fmt::join(details, "; ")));
  }
  return items;
}

/// Of a day without a load most of it is what only a load would tell: folded.
void writeFurther(Html& html, const reports::ReportCampaign& one) {
  const std::vector<std::string> items = furtherWords(*one.audit, one.diagnosis != nullptr && one.diagnosis->usable);
  if (isLoaded(one)) return html.list(items);
  if (items.empty()) return;
  const auto fold = html.element("details");
  html.leaf("summary", "What could not be checked on such a day, and why");
  html.list(items);
}

/// What nothing tells, where a pass needs it.
void writeUnanswered(Html& html, const audit::AuditReport& report) {
  if (report.unanswered.empty()) return;
  html.paragraph("Nothing in this campaign tells, and a pass needs it:");
  std::vector<std::string> items;
  for (const Remark& one : report.unanswered) items.push_back(reports::withMicro(reports::words(one)) + ".");
  html.list(items);
}

void writeRejected(Html& html, const reports::ReportCampaign& one) {
  const auto& rejected = one.audit->rejected;
  if (rejected.empty()) {
    html.paragraph("No reading was rejected.");
    return;
  }
  const bool raw = one.preparation != nullptr && one.preparation->raw;
  html.paragraph(fmt::format("{} reading{} rejected{}:", rejected.size(), rejected.size() == 1 ? "" : "s",
                             raw ? ", but used all the same, because raw readings were asked for"
                                 : " and left out of everything on this page"));
  const auto words = [](const preparation::RejectedReading& reading) {
    return reports::withMicro(reports::rejectedWords(reading));
  };
  html.list(reports::listed(rejected, words, reports::kListedInResults));
}

}  // namespace

std::vector<std::string> suspectedWords(const audit::AuditReport& report) {
  std::vector<std::string> items;
  for (const mistakes::Suspected& one : report.suspected) {
    items.push_back(fmt::format("Suspected: {} of the {}; {}{}{}.", reports::auditName(std::string(one.mistake.name())),
                                reports::words(one.where), reports::words(one.remedy), one.shown.empty() ? "" : "; ",
                                reports::words(one.shown)));
  }
  return items;
}

bool isAudited(const reports::ReportCampaign& one) { return one.audit != nullptr; }

void writeAudit(Html& html, const reports::ReportContent& content) {
  const auto write = [&](const reports::ReportCampaign& one) {
    html.paragraph(fmt::format("{} {} of {} checks could be made.",
                               reports::auditMeaning(*one.audit, kindOf(one), false), one.audit->made, one.audit->of));
    if (isLoaded(one)) writeUnanswered(html, *one.audit);
    writeTable(html, findingsTable(*one.audit));
    html.list(suspectedWords(*one.audit));
    writeTable(html, passedTable(*one.audit));
    writeFurther(html, one);
    if (anyByChance(*one.audit)) {
      html.paragraph(
          "Limits by chi-square, normal deviates or Student's t share 1\u00a0% of false findings over the "
          "whole audit.",
          "faint");
    }
    writeRejected(html, one);
  };
  writeForEach(html, content, "audit", "Audit of the readings", isAudited, write);
}

namespace {

/// Postures and parameters; joints, methods and the wrist centre say so where their numbers would stand.
std::vector<std::string> leftOut(const reports::ReportCampaign& one) {
  if (one.accuracy != nullptr) {
    const auto words = [](const preparation::RejectedReading& reading) {
      return reports::withMicro(reports::rejectedWords(reading)) + ".";
    };
    return reports::listed(one.accuracy->calibration.rejected, words, reports::kListedInResults);
  }
  if (!isLoaded(one)) return {};
  const identification::Identification& result = one.identification;
  std::vector<std::string> items = reports::listed(result.left_out, reports::leftOutWords, reports::kListedInResults);
  if (std::string kept = reports::geometryKeptWords(result.calibration); !kept.empty())
    items.push_back(std::move(kept));
  return items;
}

}  // namespace

bool hasLeftOut(const reports::ReportCampaign& one) { return !leftOut(one).empty(); }

void writeLeftOut(Html& html, const reports::ReportContent& content) {
  const auto write = [&](const reports::ReportCampaign& one) { html.list(leftOut(one)); };
  writeForEach(html, content, "left-out", "What was left out, and why", hasLeftOut, write);
}

namespace {

reports::Table namedTable(const char* id, const char* caption, const char* name, const char* value,
                          const std::vector<reports::NamedText>& lines) {
  reports::Table table{caption, {name, value}, {{}}, true, id};
  for (const reports::NamedText& line : lines) table.groups.front().rows.push_back({line.name, line.text});
  return table;
}

}  // namespace

void writeProvenance(Html& html, const reports::ReportContent& content) {
  writeForEach(html, content, "provenance", "Inputs", isAny, [&](const reports::ReportCampaign& one) {
    if (one.campaign.inputs.empty()) html.paragraph("No file was read: the campaign comes from memory.");
    reports::Table table{"Files read", {"File", "SHA-256 of its bytes"}, {{}}, true, "inputs"};
    for (const campaign::InputFile& file : one.campaign.inputs)
      table.groups.front().rows.push_back({reports::asIs(file.name), "`" + file.sha256 + "`"});
    writeTable(html, table);
  });
}

bool hasVersions(const reports::ReportContent& content) {
  return !content.versions.empty() || !content.settings.empty() || !content.command_line.empty();
}

void writeVersions(Html& html, const reports::ReportContent& content) {
  const auto section = html.element("section", {{"id", "versions"}});
  html.leaf("h2", "How this page was made");
  if (!content.command_line.empty()) {
    const auto line = html.element("p");
    html.text("Command: ");
    // Not rich: a command is shown to the letter.
    const auto code = html.element("code");
    html.text(content.command_line);
  }
  writeTable(html, namedTable("versions", "Versions", "Program or library", "Version", content.versions));
  writeTable(html, namedTable("settings", "Settings", "Setting", "Value", content.settings));
}

void writeScope(Html& html, const reports::ReportContent& content) {
  const auto section = html.element("section", {{"id", "scope"}});
  html.leaf("h2", "Uncertainty, decision rule and scope");
  std::vector<std::string> items;
  if (!content.limits_file.empty()) items.push_back(reports::decisionRuleWords());
  const bool weighed = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                                   [](const auto& one) { return reports::hiddenIsHeld(one.identification); });
  using reports::DayKind;
  for (const DayKind kind : {DayKind::unloaded, DayKind::loaded, DayKind::sweeps}) {
    if (!reports::anyOfKind(content.campaigns, kind)) continue;
    for (const std::string& item : reports::scopeWords(kind, !content.limits_file.empty(), weighed)) {
      if (std::find(items.begin(), items.end(), item) == items.end()) items.push_back(item);
    }
  }
  items.emplace_back(
      "The results relate only to the items measured, in the state and under the conditions stated here.");
  items.emplace_back(
      "Number and date of this report are those of its input: the same files and settings give the same report.");
  html.list(items);
}

}  // namespace stiffscope::page
