#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/input/units.h"
#include "reports/page/effect_words.h"
#include "reports/page/html_table.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"
#include "reports/page/sections.h"
#include "reports/page/with_micro.h"

namespace stiffscope::page {

namespace {

constexpr double kMega = 1e-6;  // to 10^6 Nm/rad

std::string inUm(double metres) { return fixed(metres / kMicrometre, 1); }

/// In percent; a gap that more than doubles has no size worth reading.
std::string shareOf(double shrink, int decimals) {
  return shrink < -1.0 ? "below −100" : fixed(100.0 * shrink, decimals);
}

std::string interval(const Shrink& shrink) {
  if (shrink.high < -1.0) return "–";
  return fmt::format("{} to {}", shareOf(shrink.low, 0), shareOf(shrink.high, 0));
}

/// What is present, with what it means.
std::string findingOf(const Diagnosis& diagnosis) {
  const auto& entries = diagnosis.verdict.entries;
  if (entries.empty()) {
    return fmt::format(
        "Joint springs are enough for this machine on this day: what they leave is noise, or too small to "
        "matter (below {}\u00a0µm rms).",
        inUm(diagnosis.size_limit));
  }
  const std::string present =
      fmt::format("Besides joint springs the readings show {}", presentWords(diagnosis.verdict));
  std::vector<Effect> effects;
  for (const VerdictEntry& entry : entries)
    effects.insert(effects.end(), entry.effects.begin(), entry.effects.end());
  if (effects.empty()) return present + ".";
  if (effects.size() == 1) return fmt::format("{}: {}.", present, effectMeaning(effects.front()));
  std::vector<std::string> meanings;
  for (const Effect effect : effects)
    meanings.push_back(fmt::format("{}: {}", effectName(effect), effectMeaning(effect)));
  return fmt::format("{}. That is, {}.", present, fmt::join(meanings, "; "));
}

std::string figuresOf(const Diagnosis& diagnosis) {
  const bool named = !namedWords(diagnosis.verdict).empty();
  const std::string noise = fmt::format("of which noise is {}\u00a0µm", inUm(diagnosis.gap.noise));
  if (!named) {
    return fmt::format("The gap is {}\u00a0µm rms per coordinate, {}.", inUm(diagnosis.gap.before), noise);
  }
  const auto entries = std::count_if(diagnosis.verdict.entries.begin(), diagnosis.verdict.entries.end(),
                                     [](const VerdictEntry& entry) { return !entry.effects.empty(); });
  return fmt::format(
      "With {} in the model the gap falls from {} to {}\u00a0µm rms per coordinate, {}; on postures that "
      "took no part "
      "it shrinks by {}\u00a0% (95\u00a0%: {}\u00a0%).",
      entries > 1 ? "them" : "it", inUm(diagnosis.gap.before), inUm(diagnosis.gap.after), noise,
      fixed(100.0 * diagnosis.shrink_together.value, 0), interval(diagnosis.shrink_together));
}

/// What a laboratory can do with the verdict: remedies, each once, and measurements. Rich texts.
std::vector<std::string> actionsOf(const Diagnosis& diagnosis) {
  std::vector<std::string> actions;
  const bool several = diagnosis.verdict.entries.size() > 1;
  for (const VerdictEntry& entry : diagnosis.verdict.entries) {
    if (entry.effects.empty()) {
      actions.push_back(
          "Look for what is not in the list of effects (the figures below show where) before the "
          "stiffnesses are used for compensation.");
    }
    std::vector<std::string> of_class;
    for (const Effect effect : entry.effects) {
      std::string remedy = effectRemedy(effect);
      if (std::find(of_class.begin(), of_class.end(), remedy) == of_class.end())
        of_class.push_back(std::move(remedy));
    }
    for (const std::string& remedy : of_class) {
      const std::string action =
          of_class.size() > 1
              ? fmt::format("If it is {}: {}.",
                            effectName(entry.effects[static_cast<std::size_t>(&remedy - of_class.data())]),
                            remedy)
          : several ? capitalised(effectNames(entry.effects)) + ": " + remedy + "."
                    : capitalised(remedy) + ".";
      if (std::find(actions.begin(), actions.end(), action) == actions.end()) actions.push_back(action);
    }
  }
  for (const NextMeasurement& one : diagnosis.next) {
    actions.push_back(fmt::format("To tell {} apart, measure {}.", effectNames(one.separates, " and "),
                                  withMicro(one.what)));
  }
  return actions;
}

/// The geometry is judged by a tolerance, not by BIC.
std::string fallOf(const EffectClass& one) {
  return one.effects.front() == Effect::kinematic_error ? "–" : significant(one.score, 3);
}

Table classesTable(const Diagnosis& diagnosis) {
  Table table{"Which effect: the verdict's first, then the other candidates, best first",
              {"Effect", "In the verdict", "Fall of BIC", "Shrink held out (%)", "95 % (%)", "Explained (%)"},
              {},
              false,
              "diagnosis"};
  RowGroup group;
  for (const EffectClass& one : diagnosis.classes) {
    group.rows.push_back({Cell(effectNames(one.effects), asIs(shortDetail(one.detail))),
                          one.in_verdict ? "yes" : "no", fallOf(one), shareOf(one.shrink.value, 1),
                          interval(one.shrink), fixed(100.0 * one.explained, 0)});
  }
  table.groups.push_back(std::move(group));
  return table;
}

const WhereRow* rowOf(const std::vector<WhereTable>& tables, const std::string& by, const std::string& name) {
  for (const WhereTable& table : tables) {
    if (table.by != by) continue;
    for (const WhereRow& row : table.rows) {
      if (row.name == name) return &row;
    }
  }
  return nullptr;
}

/// The deflection's gap, and beside it that of unloaded positions where these were tested.
Table whereTable(const Diagnosis& diagnosis) {
  const bool positions = !diagnosis.where_positions.empty();
  Table table{"Where the gap lies that joint stiffnesses leave, rms per coordinate",
              {"By", "Part", "Deflection (µm)", "Noise (µm)", "Share (%)", "Above noise (sd)"},
              {},
              false,
              "gap"};
  if (positions) {
    for (const char* column : {"Unloaded (µm)", "Noise (µm)"}) table.columns.emplace_back(column);
  }
  if (!diagnosis.as_measured.rows.empty()) table.caption += ", the station's motion taken off";
  for (const WhereTable& one : diagnosis.where) {
    if (one.by == "posture") continue;  // a figure, and results.json
    RowGroup group{one.by, {}};
    for (const WhereRow& row : one.rows) {
      Row cells{asIs(row.name), inUm(row.rms), inUm(row.noise), fixed(100.0 * row.share, 0),
                fixed(row.significance, std::abs(row.significance) < 10.0 ? 1 : 0)};
      if (positions) {
        const WhereRow* at_rest = rowOf(diagnosis.where_positions, one.by, row.name);
        cells.emplace_back(at_rest ? inUm(at_rest->rms) : "–");
        cells.emplace_back(at_rest ? inUm(at_rest->noise) : "–");
      }
      group.rows.push_back(std::move(cells));
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

Table stiffnessTable(const Diagnosis& diagnosis) {
  Table table{
      "Joint stiffness in the diagnosis, by joint springs alone and with the verdict's effects in the model, "
      "k ± u, "
      "10⁶\u00a0Nm/rad",
      {"Joint", "Alone", "With the effects"},
      {},
      false,
      "diagnosis-stiffness"};
  RowGroup group;
  for (int j = 0; j < 6; ++j) {
    if (!diagnosis.identifiable[static_cast<std::size_t>(j)]) continue;
    const double sd = kMega * diagnosis.stiffness_after_sd[j];
    group.rows.push_back({jointName(j), toPlaceOf(kMega * diagnosis.stiffness_before[j], sd),
                          withUncertainty(kMega * diagnosis.stiffness_after[j], sd)});
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
    if (one.size) group.rows.push_back({effectName(one.effect), inUm(*one.size)});
  }
  table.groups.push_back(std::move(group));
  return table;
}

void writeNotTestable(Html& html, const Diagnosis& diagnosis) {
  if (diagnosis.not_testable.empty()) return;
  html.paragraph("Not testable with this data:");
  std::vector<std::string> missing;
  for (const NotTestable& one : diagnosis.not_testable)
    missing.push_back(fmt::format("{}: {}.", effectName(one.effect), withMicro(one.missing)));
  html.list(missing);
}

void writeDiagnosis(Html& html, const Diagnosis& diagnosis) {
  if (!diagnosis.usable) {
    html.paragraph(fmt::format("No diagnosis: {}.", asIs(diagnosis.unusable_reason)));
    return;
  }
  html.paragraph(asIs(findingOf(diagnosis)), "finding");
  html.paragraph(figuresOf(diagnosis));
  const std::vector<std::string> actions = actionsOf(diagnosis);
  if (!actions.empty()) html.paragraph("What to do:");
  html.list(actions);
  html.paragraph(withMicro(diagnosis.verdict.reason), "faint");
  writeTable(html, classesTable(diagnosis));
  if (!namedWords(diagnosis.verdict).empty()) {
    writeTable(html, stiffnessTable(diagnosis));
    html.paragraph(
        "These stiffnesses are not those of Joint stiffness: the diagnosis fits all load steps together, "
        "sweeps and unloaded "
        "positions beside them, and its u is one standard uncertainty by weights of the noise; there k is of "
        "one load step and U "
        "is expanded (about 95\u00a0%), from the scatter between postures. The stiffnesses to use are those "
        "of Joint stiffness, "
        "with the effects where a report is made with them (--with auto).",
        "faint");
  }
  writeTable(html, whereTable(diagnosis));
  writeNotTestable(html, diagnosis);
  const auto fold = html.element("details");  // the figure has these numbers, too
  html.leaf("summary", "The smallest sizes as a table");
  writeTable(html, detectableTable(diagnosis));
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
