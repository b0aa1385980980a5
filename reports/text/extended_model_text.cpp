#include "core/extended_model/extended_model.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/identification/estimate.h"
#include "core/io/units.h"
#include "reports/words/effect_words.h"
#include "reports/words/extended_model_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

using Out = std::back_insert_iterator<std::string>;

/// Metres and radians in the units of the rest of the text.
extended_model::EffectParameter inTextUnits(extended_model::EffectParameter parameter) {
  if (parameter.unit != "m" && parameter.unit != "rad") return parameter;
  parameter.value /= io::kMicrometre;  // to um, or to urad
  parameter.sd /= io::kMicrometre;
  parameter.unit = "u" + parameter.unit;
  return parameter;
}

void writeEffect(const extended_model::AddedEffect& one, Out out) {
  fmt::format_to(out, "  {}{}{}\n", effectName(one.effect), one.detail.empty() ? "" : " (" + one.detail + ")",
                 one.shape.empty() ? "" : ", " + one.shape);
  fmt::format_to(out, "    {}\n", wrapped(reports::effectUse(one.effect), 4));
  for (const extended_model::EffectParameter& own : one.parameters) {
    const extended_model::EffectParameter parameter = inTextUnits(own);
    const std::string name = parameter.name.empty() ? "size" : parameter.name;
    if (parameter.value == 0.0) {
      fmt::format_to(out, "    {:<24} 0 (none found)\n", name);
      continue;
    }
    fmt::format_to(out, "    {:<24}{:>12.4g} +-{:.2g} {}\n", name, parameter.value, expanded(parameter.sd),
                   parameter.unit);
  }
  if (const std::string doubt = doubtOf(one); !doubt.empty())
    fmt::format_to(out, "    {}\n", wrapped("Caution: " + doubt + ".", 4));
}

std::string stiffnessCell(const identification::StiffnessEstimate& estimate, int joint, const StiffnessUnit& unit) {
  if (!estimate.identifiable[static_cast<std::size_t>(joint)]) return "-";
  const double expanded = identification::expandedUncertainty(estimate, joint) / unit.size;
  return fmt::format("{:.4f} +-{}", estimate.stiffness(joint) / unit.size,
                     std::isfinite(expanded) ? fmt::format("{:.4f}", expanded) : "?");
}

std::string heldOutCell(const identification::MethodResult& method,
                        const std::optional<identification::Compensation>& share) {
  if (!share) return "-";
  if (method.subsets.compliances.empty()) return fmt::format("{:.2f}", 100.0 * share->all_postures);
  return fmt::format("{:.2f} ({:.2f})", 100.0 * share->subsets.held_out, 100.0 * share->held_out_sd);
}

/// The standard uncertainty that the effects alone make.
std::string byEffects(const identification::StiffnessEstimate& estimate, int joint, const StiffnessUnit& unit) {
  if (!estimate.identifiable[static_cast<std::size_t>(joint)]) return "-";
  return fmt::format("{:.4f}", std::sqrt(estimate.parts.effects(joint, joint)) /
                                   (estimate.compliance[joint] * estimate.compliance[joint]) / unit.size);
}

void writeStiffnesses(const extended_model::ExtendedModel& model, const std::vector<identification::Method>& methods,
                      Out out) {
  const StiffnessUnit unit = stiffnessUnit(model.with);
  fmt::format_to(out,
                 "\nStiffness without and with, {}, with its expanded uncertainty U; by effects: their part of "
                 "the\n  standard uncertainty\n  {:<14}",
                 unit.text, "");
  const auto joints = static_cast<int>(model.with.identifiability.joints.size());
  for (int joint = 1; joint <= joints; ++joint) fmt::format_to(out, " {:>17}", fmt::format("k{}", joint));
  fmt::format_to(out, "\n");
  for (const identification::Method which : methods) {
    const auto row = [&](const char* name, const identification::MethodResult& method, const auto& cell) {
      if (!method.available) return;
      fmt::format_to(out, "  {:<14}", fmt::format("{} {}", namesOf(which).brief, name));
      for (int joint = 0; joint < joints; ++joint) fmt::format_to(out, " {:>17}", cell(method.estimate, joint, unit));
      fmt::format_to(out, "\n");
    };
    row(model.hidden ? "apparent" : "without", model.without.of(which), stiffnessCell);
    row("with", model.with.of(which), stiffnessCell);
    row("by effects", model.with.of(which), byEffects);
  }
}

void writeResiduals(const extended_model::ExtendedModel& model, const std::vector<identification::Method>& methods,
                    Out out) {
  fmt::format_to(out, "\n  {:<14}{:>20}{:>26}{:>20}\n  {:<14}{:>20}{:>26}{:>20}\n", "", "rms residual (µm)",
                 "compensated at P_wrist", "at the reflectors", "", "", "held out (sd), %", "held out (sd), %");
  for (const identification::Method which : methods) {
    const auto row = [&](const char* name, const identification::MethodResult& method) {
      if (!method.available) return;
      fmt::format_to(out, "  {:<14}{:>20.1f}{:>26}{:>20}\n", fmt::format("{} {}", namesOf(which).brief, name),
                     method.estimate.rms_residual / io::kMicrometre, heldOutCell(method, method.at_wrist),
                     heldOutCell(method, method.at_targets));
    };
    row("without", model.without.of(which));
    row("with", model.with.of(which));
  }
}

/// Standard uncertainties of k in per cent, line by line; lines that are nowhere above a twentieth of the whole are
/// left out.
void writeBudget(const std::vector<extended_model::BudgetLine>& budget,
                 const identification::StiffnessEstimate& estimate, identification::Method which, Out out) {
  if (budget.empty()) return;
  fmt::format_to(out, "\nWhere the uncertainty of {} comes from: standard uncertainty of k, %\n  {:<34}",
                 namesOf(which).brief, "");
  for (int joint = 1; joint <= estimate.joints(); ++joint) fmt::format_to(out, "{:>10}", fmt::format("k{}", joint));
  fmt::format_to(out, "\n");
  const auto cell = [&](int j, double variance) {
    if (!estimate.identifiable[static_cast<std::size_t>(j)]) return std::string("-");
    const double share = std::sqrt(std::abs(variance)) / std::abs(estimate.compliance[j]);
    return fmt::format("{}{:.2f}", variance < 0.0 ? "-" : "", 100.0 * share);
  };
  const auto row = [&](const std::string& name, const JointVector& variance) {
    fmt::format_to(out, "  {:<34}", name);
    for (int j = 0; j < estimate.joints(); ++j) fmt::format_to(out, "{:>10}", cell(j, variance[j]));
    fmt::format_to(out, "\n");
  };
  constexpr double kShown = 0.05 * 0.05;
  for (const extended_model::BudgetLine& line : budget) {
    bool shown = line.in_model;
    for (int j = 0; j < estimate.joints(); ++j)
      shown = shown || (estimate.identifiable[static_cast<std::size_t>(j)] &&
                        std::abs(line.variance[j]) > kShown * estimate.covariance(j, j));
    if (shown) row(budgetWords(line), line.variance);
  }
  row("together", estimate.covariance.diagonal());
}

/// Of the method that a reader takes first.
void writeHidden(const extended_model::ExtendedModel& model, const std::vector<identification::Method>& methods,
                 Out out) {
  fmt::format_to(out, "\n{}\n", wrapped(residualWords(model), 0));
  const auto best = identification::bestMethodOf(model.with, methods);
  if (!best) return;
  const auto at = static_cast<std::size_t>(*best);
  writeBudget(model.hidden->budget[at], model.with.of(*best).estimate, *best, out);
  for (const extended_model::SeenCombination& one : model.hidden->combinations[at])
    fmt::format_to(out, "  {}\n", wrapped(fmt::format("{}: {}", namesOf(*best).brief, combinationWords(one)), 4));
}

}  // namespace

std::string addedEffectsText(const extended_model::EffectFit& effects) {
  std::string text = fmt::format("\nAdded to the joint springs{}: {}\n", effects.added.empty() ? "" : " (+- U, 95 %)",
                                 addedNames(effects));
  const auto out = std::back_inserter(text);
  for (const extended_model::AddedEffect& one : effects.added) writeEffect(one, out);
  for (const effects::Effect effect : effects.geometry)
    fmt::format_to(out, "  {}\n", wrapped(fmt::format("{}: {}", effectName(effect), reports::effectUse(effect)), 4));
  for (const std::string& note : words(effects.notes)) fmt::format_to(out, "  {}\n", wrapped("Note: " + note + ".", 4));
  if (!effects.added.empty()) fmt::format_to(out, "{}\n", wrapped(explainedWords(effects), 0));
  return text;
}

std::string extendedModelText(const extended_model::ExtendedModel& model,
                              const std::vector<identification::Method>& methods) {
  std::string text = addedEffectsText(model.effects);
  const auto out = std::back_inserter(text);
  if (model.effects.added.empty()) {
    if (model.hidden) writeHidden(model, methods, out);
    return text;
  }
  writeStiffnesses(model, methods, out);
  writeResiduals(model, methods, out);
  fmt::format_to(
      out, "{}\n",
      wrapped("Held out: springs and effects fitted anew on the postures of each subset; parts of an effect stay as "
              "chosen. Stiffnesses are those of the joint springs beside the effects.",
              0));
  if (model.hidden) writeHidden(model, methods, out);
  return text;
}

}  // namespace stiffscope::reports
