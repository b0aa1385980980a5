#include <fmt/format.h>

#include <algorithm>

#include "core/input/units.h"
#include "reports/diagnosis_words.h"
#include "reports/page/html_table.h"
#include "reports/page/numbers.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

namespace {

std::string inUm(double metres) { return fixed(metres / kMicrometre, 1); }

std::string interval(const Shrink& shrink) {
  return fmt::format("{} to {}", fixed(100.0 * shrink.low, 0), fixed(100.0 * shrink.high, 0));
}

/// What a laboratory can do with the verdict.
std::string actionOf(const Diagnosis& diagnosis) {
  const auto& entries = diagnosis.verdict.entries;
  if (entries.empty()) {
    return fmt::format("The joint-stiffness model is enough for this machine on this day: what it leaves is noise, or too "
                       "small to matter (below {}\u00a0µm rms).",
                       inUm(diagnosis.size_limit));
  }
  const bool unknown = std::any_of(entries.begin(), entries.end(),
                                   [](const VerdictEntry& one) { return one.effects.empty(); });
  std::string words = fmt::format(
      "The machine does what the joint-stiffness model does not: {}. With it in the model the gap falls from {} to "
      "{}\u00a0µm rms per coordinate, of which noise is {}\u00a0µm; on postures that took no part it shrinks by {} % "
      "(95 %: {} %).",
      verdictWords(diagnosis.verdict), inUm(diagnosis.gap.before), inUm(diagnosis.gap.after), inUm(diagnosis.gap.noise),
      fixed(100.0 * diagnosis.shrink_together.value, 0), interval(diagnosis.shrink_together));
  if (unknown) {
    words += " Part of it is explained by no effect of the vocabulary: look for what is not in the list before the "
             "stiffnesses are used for compensation.";
  }
  return words;
}

Table classesTable(const Diagnosis& diagnosis) {
  Table table{"Which effect: candidates, best first",
              {"Effect", "In the verdict", "Fall of BIC", "Shrink held out (%)", "95 % (%)", "Explained (%)"},
              {},
              false,
              "diagnosis"};
  RowGroup group;
  for (const EffectClass& one : diagnosis.classes) {
    group.rows.push_back({Cell(effectNames(one.effects), one.detail), one.in_verdict ? "yes" : "no", fixed(one.score, 0),
                          fixed(100.0 * one.shrink.value, 1), interval(one.shrink), fixed(100.0 * one.explained, 0)});
  }
  table.groups.push_back(std::move(group));
  return table;
}

Table whereTable(const std::vector<WhereTable>& tables, const std::string& caption, const std::string& id) {
  Table table{caption, {"By", "", "rms (µm)", "Noise (µm)", "Share (%)", "Above noise (sd)"}, {}, false, id};
  for (const WhereTable& one : tables) {
    if (one.by == "posture") continue;  // a figure, and results.json
    RowGroup group{one.by, {}};
    for (const WhereRow& row : one.rows) {
      group.rows.push_back({row.name, inUm(row.rms), inUm(row.noise), fixed(100.0 * row.share, 0), fixed(row.significance, 1)});
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

Table stiffnessTable(const Diagnosis& diagnosis) {
  Table table{"Stiffness before and after the effect is in the model, 10^{6}\u00a0Nm/rad",
              {"Joint", "Before", "After", "u(after)"},
              {},
              false,
              "diagnosis-stiffness"};
  RowGroup group;
  for (int j = 0; j < 6; ++j) {
    if (!diagnosis.identifiable[static_cast<std::size_t>(j)]) continue;
    group.rows.push_back({fmt::format("k_{{{}}}", j + 1), fixed(1e-6 * diagnosis.stiffness_before[j], 4),
                          fixed(1e-6 * diagnosis.stiffness_after[j], 4), fixed(1e-6 * diagnosis.stiffness_after_sd[j], 4)});
  }
  table.groups.push_back(std::move(group));
  return table;
}

Table detectableTable(const Diagnosis& diagnosis) {
  Table table{"Smallest size that would have been seen, rms per coordinate",
              {"Effect", "Size (µm)"},
              {},
              false,
              "diagnosis-detectable"};
  RowGroup group;
  for (const DetectableSize& one : diagnosis.detectable) {
    if (one.size) group.rows.push_back({std::string(idOf(one.effect)), inUm(*one.size)});
  }
  table.groups.push_back(std::move(group));
  return table;
}

void writeDiagnosis(Html& html, const Diagnosis& diagnosis) {
  if (!diagnosis.usable) {
    html.paragraph(fmt::format("No diagnosis: {}.", asIs(diagnosis.unusable_reason)));
    return;
  }
  html.paragraph(asIs(actionOf(diagnosis)));
  html.paragraph(asIs(diagnosis.verdict.reason), "faint");
  writeTable(html, classesTable(diagnosis));
  for (const auto& group : diagnosis.aliases) {
    html.paragraph(asIs(fmt::format("These postures and loads cannot always separate {}.", effectNames(group))), "faint");
  }
  writeTable(html, whereTable(diagnosis.where, "Where the deflection's gap lies", "gap"));
  writeTable(html, whereTable(diagnosis.where_positions, "Where the gap of unloaded positions lies", "gap-positions"));
  if (!diagnosis.verdict.entries.empty()) writeTable(html, stiffnessTable(diagnosis));
  writeTable(html, detectableTable(diagnosis));
  std::vector<std::string> missing;
  for (const NotTestable& one : diagnosis.not_testable) {
    missing.push_back(asIs(fmt::format("{} is not testable here: {}.", idOf(one.effect), one.missing)));
  }
  html.list(missing);
  if (diagnosis.next.empty()) return;
  html.leaf("h3", "What to measure next");
  std::vector<std::string> next;
  for (const NextMeasurement& one : diagnosis.next) next.push_back(asIs(one.what));
  html.list(next);
}

}  // namespace

void writeGap(Html& html, const ReportContent& content) {
  const bool any = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                               [](const ReportCampaign& one) { return one.diagnosis != nullptr; });
  if (!any) return;
  writeForEach(html, content, "gap", "What the model misses", [&](const ReportCampaign& one) {
    if (one.diagnosis != nullptr) writeDiagnosis(html, *one.diagnosis);
  });
}

}  // namespace stiffscope::page
