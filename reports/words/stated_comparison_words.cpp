#include "reports/words/stated_comparison_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/rich_text.h"

namespace stiffscope::reports {

namespace {

constexpr double kMicroradian = 1e-6;
const char* const kNone = "–";

std::string probabilityWords(double p) {
  if (!std::isfinite(p)) return kNone;
  return p < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", p);
}

std::string significanceWords(const comparison::StatedChange& change) {
  if (!std::isfinite(change.p_holm)) return "not known";
  return change.significant() ? "yes" : "no";
}

std::string intervalCell(const std::optional<comparison::StatedCompliance>& compliance, double unit) {
  if (!compliance) return kNone;
  const identification::CoverageInterval k = identification::stiffnessInterval(compliance->interval);
  const double value = 1.0 / compliance->value, width = std::isfinite(k.high) ? k.high - k.low : value;
  const auto shown = [&](double number) { return toPlaceOf(number / unit, width / unit); };
  return fmt::format("{} ({} to {})", shown(value), shown(k.low), std::isfinite(k.high) ? shown(k.high) : "∞");
}

DataCell valueCell(double value) { return std::isfinite(value) ? DataCell(value) : DataCell(); }

/// All stiffnesses of both, for the unit that suits the smallest of them.
std::vector<double> stiffnessesOf(const StatedComparison& comparison) {
  std::vector<double> all;
  for (const StatedCampaign* one : {&comparison.before, &comparison.after}) {
    for (const auto& method : one->compliances) {
      for (const auto& compliance : method) {
        if (compliance) all.push_back(1.0 / compliance->value);
      }
    }
  }
  return all;
}

Table stiffnessTable(const StatedComparison& comparison) {
  const StiffnessUnit unit = stiffnessUnit(stiffnessesOf(comparison));
  Table table{std::string("Joint stiffness k in ") + unit.name +
                  " with its 95 % interval, and the difference of compliances c = 1/k",
              {"", "", "before", "after", "after − before, µrad/Nm", "p", "p (Holm)", "significant (5 %)"},
              {}};
  table.id = "stiffness";
  table.data = DataTable{{"joint", "method", "before_nm_per_rad", "after_nm_per_rad", "difference_rad_per_nm",
                          "u_difference_rad_per_nm", "p_value", "p_value_holm"},
                         {}};
  for (const identification::Method method : identification::kMethods) {
    const std::size_t m = static_cast<std::size_t>(method);
    if (comparison.changes[m].empty()) continue;
    RowGroup group{shortName(method) + (method == comparison.shown_first ? ", shown first" : ""), {}};
    for (std::size_t j = 0; j < comparison.changes[m].size(); ++j) {
      const auto &before = comparison.before.compliances[m][j], &after = comparison.after.compliances[m][j];
      const auto& change = comparison.changes[m][j];
      Row row{jointName(static_cast<int>(j)), intervalCell(before, unit.size), intervalCell(after, unit.size)};
      if (change) {
        row.insert(
            row.end(),
            {withUncertainty(change->difference.value / kMicroradian, change->difference.expanded() / kMicroradian),
             probabilityWords(change->p_value), probabilityWords(change->p_holm), significanceWords(*change)});
      } else {
        row.insert(row.end(), {kNone, kNone, kNone, before || after ? "stated by one alone" : "not identifiable"});
      }
      group.rows.push_back(std::move(row));
      table.data->rows.push_back(
          {static_cast<double>(j + 1), namesOf(method).key, before ? DataCell(1.0 / before->value) : DataCell(),
           after ? DataCell(1.0 / after->value) : DataCell(), change ? valueCell(change->difference.value) : DataCell(),
           change ? valueCell(change->difference.expanded()) : DataCell(),
           change ? valueCell(change->p_value) : DataCell(), change ? valueCell(change->p_holm) : DataCell()});
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

const StatedPosture::At& placeOf(const StatedComparison& comparison, const StatedPosture& posture) {
  return comparison.at_wrist ? posture.wrist : posture.targets;
}

Table residualTable(const StatedComparison& comparison) {
  const auto method = *comparison.shown_first;
  const std::size_t m = static_cast<std::size_t>(method);
  Table table{fmt::format("Postures at {}, mm: the deflection, and what {} leaves of it",
                          comparison.at_wrist ? "P_{wrist}" : "the reflectors (means)", shortName(method)),
              {"posture", "deflection before", "deflection after", "left before", "left after"},
              {{"", {}}}};
  table.id = "postures";
  for (const StatedComparison::Pair& pair : comparison.postures) {
    const StatedPosture& posture = comparison.before.postures[pair.before];
    const StatedPosture::At &before = placeOf(comparison, posture),
                            &after = placeOf(comparison, comparison.after.postures[pair.after]);
    if (!std::isfinite(before.deflection_mm) && !std::isfinite(after.deflection_mm)) continue;
    table.groups.front().rows.push_back({asIs(posture.pose), fixed(before.deflection_mm, 3),
                                         fixed(after.deflection_mm, 3), fixed(before.residual_mm[m], 3),
                                         fixed(after.residual_mm[m], 3)});
  }
  return table;
}

Table gapTable(const StatedComparison& comparison) {
  Table table{
      "What the diagnosis leaves in a posture, µm rms per coordinate: before and after its effects are in the "
      "model",
      {"posture", "before: gap", "before: with effects", "after: gap", "after: with effects"},
      {{"", {}}}};
  table.id = "gap";
  const auto& [a, b] = std::tie(comparison.before.diagnosis, comparison.after.diagnosis);
  if (!a || !b || a->unloaded != b->unloaded) return table;
  for (const StatedComparison::Pair& pair : comparison.postures) {
    const StatedPosture &before = comparison.before.postures[pair.before],
                        &after = comparison.after.postures[pair.after];
    if (!std::isfinite(before.gap_um) || !std::isfinite(after.gap_um)) continue;
    table.groups.front().rows.push_back({asIs(before.pose), fixed(before.gap_um, 1), fixed(before.gap_after_um, 1),
                                         fixed(after.gap_um, 1), fixed(after.gap_after_um, 1)});
  }
  return table;
}

Table linkTable(const StatedComparison& comparison) {
  Table table{"Consecutive axes as swept: distance in mm and angle in degrees, ± U (95 %)",
              {"axes", "", "before", "after", "after − before", "p (Holm)", "significant (5 %)"},
              {{"", {}}}};
  table.id = "links";
  const auto add = [&table](int axis, const char* what, const auto& before, const auto& after, const auto& change) {
    if (!change) return;
    const auto shown = [](const comparison::Uncertain& one) { return withUncertainty(one.value, expanded(one.sd)); };
    table.groups.front().rows.push_back({fmt::format("{}, {}", axis, axis + 1), what, shown(*before), shown(*after),
                                         shown(change->difference), probabilityWords(change->p_holm),
                                         significanceWords(*change)});
  };
  for (std::size_t i = 0; i < comparison.lengths.size(); ++i) {
    const StatedLink &before = comparison.before.links[i], &after = comparison.after.links[i];
    add(before.axis, "distance", before.length_mm, after.length_mm, comparison.lengths[i]);
    add(before.axis, "angle", before.angle_deg, after.angle_deg, comparison.angles[i]);
  }
  return table;
}

std::string accuracyName(const std::string& model) {
  if (model == "nominal") return "nominal geometry";
  if (model == "geometry") return "calibrated geometry";
  if (model == "gravity") return "geometry and gravity deflection";
  return asIs(model);
}

Table accuracyTable(const StatedComparison& comparison) {
  Table table{"Accuracy on postures held out, mm rms (largest)", {"model", "before", "after"}, {{"", {}}}};
  table.id = "accuracy";
  for (const StatedAccuracy& before : comparison.before.accuracy) {
    const auto after = std::find_if(comparison.after.accuracy.begin(), comparison.after.accuracy.end(),
                                    [&](const StatedAccuracy& one) { return one.model == before.model; });
    if (after == comparison.after.accuracy.end()) continue;
    const auto shown = [](const StatedAccuracy& one) {
      return fmt::format("{} ({})", fixed(one.rms_mm, 3), fixed(one.largest_mm, 3));
    };
    table.groups.front().rows.push_back({accuracyName(before.model), shown(before), shown(*after)});
  }
  return table;
}

std::string purposeWords(const std::string& purpose) {
  if (purpose == "identify") return " to identify stiffnesses";
  if (purpose == "calibrate") return " to calibrate";
  return {};
}

std::string checksWords(const StatedAudit& audit) {
  const auto names = [](const std::vector<std::string>& ids) {
    std::string words;
    for (const std::string& id : ids) words += (words.empty() ? "" : ", ") + auditName(id);
    return words;
  };
  std::string words;
  if (!audit.failed.empty()) words += "; failed: " + names(audit.failed);
  if (!audit.warned.empty()) words += "; warned: " + names(audit.warned);
  return words;
}

std::string verdictCell(const StatedAudit& audit) {
  const std::string word = audit.verdict == "pass"   ? "passes"
                           : audit.verdict == "warn" ? "passes with warnings"
                           : audit.verdict == "fail" ? "fails"
                                                     : "cannot tell";
  return word + purposeWords(audit.purpose) + checksWords(audit);
}

std::string verdictCell(const StatedDiagnosis& diagnosis) {
  if (!diagnosis.usable) return "could not be made";
  return diagnosis.verdict.empty() ? "nothing beside joint stiffnesses" : asIs(diagnosis.verdict);
}

std::string gapCell(const StatedDiagnosis& diagnosis) {
  return fmt::format("{} µm, with effects {} µm, noise {} µm", fixed(diagnosis.gap_um, 1), fixed(diagnosis.after_um, 1),
                     fixed(diagnosis.noise_um, 1));
}

/// Names of the two, and what is not the same of both.
Table apartTable(const StatedComparison& comparison) {
  Table table{"What was compared, and where the two differ", {"", "before", "after"}, {{"", {}}}, true};
  table.id = "campaigns";
  const StatedCampaign &before = comparison.before, &after = comparison.after;
  const auto add = [&table](const char* what, const std::string& a, const std::string& b) {
    table.groups.front().rows.push_back({what, a, b});
  };
  add("file", asIs(before.file), asIs(after.file));
  const auto add_text = [&](const char* what, std::string StatedCampaign::*member) {
    if (before.*member != after.*member) add(what, asIs(before.*member), asIs(after.*member));
  };
  add_text("campaign", &StatedCampaign::name);
  add_text("date", &StatedCampaign::date);
  add_text("serial number", &StatedCampaign::serial);
  add_text("double encoders", &StatedCampaign::double_encoder);
  const auto add_verdicts = [&](const char* what, const auto& a, const auto& b) {
    if (!a && !b) return;
    const std::string one = a ? verdictCell(*a) : "not in the file", other = b ? verdictCell(*b) : "not in the file";
    if (one != other) add(what, one, other);
  };
  add_verdicts("audit", before.audit, after.audit);
  add_verdicts("diagnosis", before.diagnosis, after.diagnosis);
  if (before.diagnosis && after.diagnosis && gapCell(*before.diagnosis) != gapCell(*after.diagnosis))
    add("what the model misses", gapCell(*before.diagnosis), gapCell(*after.diagnosis));
  return table;
}

}  // namespace

std::vector<std::string> saidOfBoth(const StatedComparison& comparison) {
  std::vector<std::string> said;
  const StatedCampaign &before = comparison.before, &after = comparison.after;
  said.push_back(
      "Machine: " + asIs(before.robot) +
      (before.serial.empty() || before.serial != after.serial ? "" : ", serial number " + asIs(before.serial)));
  if (before.name == after.name) said.push_back("Campaign: " + asIs(before.name));
  if (before.date == after.date) said.push_back("Date: " + asIs(before.date));
  if (before.audit && after.audit && verdictCell(*before.audit) == verdictCell(*after.audit))
    said.push_back("Audit of both: " + verdictCell(*before.audit));
  if (before.diagnosis && after.diagnosis && verdictCell(*before.diagnosis) == verdictCell(*after.diagnosis))
    said.push_back("Diagnosis of both: " + verdictCell(*before.diagnosis));
  return said;
}

std::string changedWords(const StatedComparison& comparison) {
  if (!comparison.shown_first) return {};
  const auto& changes = comparison.changes[static_cast<std::size_t>(*comparison.shown_first)];
  std::vector<std::string> changed, unchanged;
  for (std::size_t j = 0; j < changes.size(); ++j) {
    if (!changes[j] || !std::isfinite(changes[j]->p_holm)) continue;
    const bool softer = changes[j]->difference.value > 0.0;
    if (changes[j]->significant())
      changed.push_back(fmt::format("{} ({})", j + 1, softer ? "softer" : "stiffer"));
    else
      unchanged.push_back(std::to_string(j + 1));
  }
  const std::string by = " By " + shortName(*comparison.shown_first) + ", 5 %, corrected for the joints compared.";
  if (changed.empty() && unchanged.empty()) return "No joint can be compared.";
  if (changed.empty()) return "No joint's stiffness differs significantly." + by;
  return fmt::format("Joints that differ significantly: {}.{}{}", fmt::join(changed, ", "),
                     unchanged.empty() ? "" : fmt::format(" Not: {}.", fmt::join(unchanged, ", ")), by);
}

std::vector<Table> statedTables(const StatedComparison& comparison) {
  std::vector<Table> tables{apartTable(comparison)};
  if (comparison.comparesStiffness()) {
    tables.push_back(stiffnessTable(comparison));
    tables.push_back(residualTable(comparison));
  }
  tables.push_back(accuracyTable(comparison));
  tables.push_back(gapTable(comparison));
  tables.push_back(linkTable(comparison));
  std::erase_if(tables, [](const Table& table) {
    return std::all_of(table.groups.begin(), table.groups.end(),
                       [](const RowGroup& group) { return group.rows.empty(); });
  });
  return tables;
}

}  // namespace stiffscope::reports
