#include "core/audit/audit.h"
#include "core/mistakes/find_mistakes.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <iterator>

#include "reports/json/json.h"
#include "reports/words/audit_figures.h"
#include "reports/words/listed.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

using Out = std::back_insert_iterator<std::string>;

const char* worded(preparation::AuditVerdict verdict) {
  return verdict == preparation::AuditVerdict::not_testable ? "not testable" : nameOf(verdict);
}

std::string figureCell(const std::optional<double>& value) { return value ? fmt::format("{:.4g}", *value) : "-"; }

void writeChecks(const audit::AuditReport& report, Out out) {
  fmt::format_to(out, "  {:<21}{:<13}{:>10}{:>10}  {:<16}{}\n", "check", "verdict", "figure", "limit", "unit", "where");
  for (const preparation::AuditCheck& check : report.checks) {
    const AuditFigures figures = figuresOf(check);
    std::string line =
        fmt::format("  {:<21}{:<13}{:>10}{:>10}  {:<16}{}", auditName(check.id), worded(check.verdict),
                    figureCell(figures.value), figureCell(figures.limit), figures.unit, words(check.where));
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::format_to(out, "{}\n", line);
  }
}

std::string meaningOf(const audit::AuditReport& report) {
  const char* const purpose = report.purpose == audit::Purpose::calibrate ? "calibrate" : "identify";
  switch (report.verdict) {
    case preparation::AuditVerdict::pass:
      return fmt::format("pass: fit to {} from", purpose);
    case preparation::AuditVerdict::warn:
      return fmt::format("warn: fit to {} from with what is said below", purpose);
    case preparation::AuditVerdict::not_testable:
      return fmt::format("not testable: too little was measured to say whether it is fit to {} from", purpose);
    case preparation::AuditVerdict::fail:
      break;
  }
  return fmt::format("fail: not fit to {} from", purpose);
}

/// What nothing tells, where a pass needs it.
void writeUnanswered(const audit::AuditReport& report, Out out) {
  if (report.unanswered.empty()) return;
  fmt::format_to(out, "\nNothing in this campaign tells, and a pass needs it\n");
  for (const Remark& one : report.unanswered) fmt::format_to(out, "  {}\n", wrapped(words(one), 4));
}

void writeSuspected(const std::vector<mistakes::Suspected>& suspected, Out out) {
  if (suspected.empty()) return;
  fmt::format_to(out, "\nSuspected\n");
  for (const mistakes::Suspected& one : suspected) {
    fmt::format_to(out, "  {}\n",
                   wrapped(fmt::format("{} of the {}: {}{}{}", one.mistake.name(), words(one.where), words(one.remedy),
                                       one.shown.empty() ? "" : "; ", words(one.shown)),
                           4));
  }
}

/// Short arcs that still suffice pass, but a reader should know what they cost.
void writeShortArcs(const audit::AuditReport& report, Out out) {
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.id != "circle_arc" || check.verdict != preparation::AuditVerdict::pass || *check.value >= *check.limit)
      continue;
    fmt::format_to(out, "\n{}\n", wrapped(fmt::format("Passes below its limit: {}.", words(check.message)), 2));
  }
}

/// What a check found one by one: which joints the postures can identify, say.
void writeDetails(const audit::AuditReport& report, Out out) {
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.details.empty()) continue;
    fmt::format_to(out, "\n{}, in detail\n", auditName(check.id));
    for (const std::string& detail : listed(
             check.details, [](const Remark& one) { return words(one); }, kListedInJson))
      fmt::format_to(out, "  {}\n", wrapped(detail, 4));
  }
}

void writeMessages(const audit::AuditReport& report, preparation::AuditVerdict verdict, const char* title, Out out) {
  bool first = true;
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.verdict != verdict) continue;
    if (first) fmt::format_to(out, "\n{}\n", title);
    first = false;
    fmt::format_to(out, "  {}\n", wrapped(fmt::format("{}: {}", auditName(check.id), words(check.message)), 4));
    if (!check.limit_source.empty()) {
      fmt::format_to(out, "    {}\n", wrapped(fmt::format("Limit: {}.", words(check.limit_source)), 6));
    }
  }
}

}  // namespace

std::string agreementText(const mistakes::ModelAgreement& agreement) {
  if (!agreement.contradicted()) return {};
  std::string text;
  Out out(text);
  fmt::format_to(out, "\n{}\n",
                 wrapped("The day contradicts the model so far that no number above serves" +
                             std::string(agreement.arm.empty() && agreement.loads.empty()
                                             ? ": none of the usual mistakes explains it. See audit."
                                             : ": a mistake is in the files."),
                         0));
  for (const auto* cures : {&agreement.arm, &agreement.loads}) writeSuspected(*cures, out);
  return text;
}

std::string auditText(const campaign::Campaign& campaign, const audit::AuditReport& report) {
  std::string text;
  Out out(text);
  fmt::format_to(out, "{}: {}\n{} of {} checks could be made\n", campaign.name, meaningOf(report), report.made,
                 report.of);
  writeUnanswered(report, out);
  fmt::format_to(out, "\n");
  writeChecks(report, out);
  writeSuspected(report.suspected, out);
  writeMessages(report, preparation::AuditVerdict::fail, "Fails", out);
  writeMessages(report, preparation::AuditVerdict::warn, "Warns", out);
  if (report.purpose == audit::Purpose::identify) {
    writeMessages(report, preparation::AuditVerdict::not_testable, "Not testable", out);
  } else if (report.made < report.of) {
    fmt::format_to(out, "\n{}\n",
                   wrapped("The other checks need sweeps, loads or a load cell, which this day does not have "
                           "(reasons in the JSON).",
                           0));
  }
  writeShortArcs(report, out);
  writeDetails(report, out);
  if (!report.rejected.empty())
    fmt::format_to(out, "\nReadings to leave out, as the other commands do without --raw\n");
  for (const std::string& entry : listed(report.rejected, rejectedWords, kListedInJson))
    fmt::format_to(out, "  {}\n", wrapped(entry, 4));
  return text;
}

}  // namespace stiffscope::reports
