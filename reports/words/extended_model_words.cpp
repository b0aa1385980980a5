#include "reports/words/extended_model_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/identification/identification.h"
#include "core/io/units.h"
#include "reports/words/effect_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

std::string addedNames(const extended_model::EffectFit& effects) {
  if (effects.added.empty()) return "nothing";
  std::vector<std::string> names;
  for (const extended_model::AddedEffect& one : effects.added) {
    names.push_back(one.detail.empty() ? effectName(one.effect)
                                       : fmt::format("{} ({})", effectName(one.effect), one.detail));
  }
  return fmt::format("{}", fmt::join(names, " and "));
}

std::string explainedWords(const extended_model::EffectFit& effects) {
  const diagnosis::Gap& gap = effects.gap;
  const diagnosis::Shrink& shrink = effects.shrink;
  const std::string left = fmt::format(
      "Stiffnesses alone leave {} rms per coordinate of the deflection in all load steps, with the effects {}; noise "
      "alone {}. ",
      withMicro(lengthWords(gap.before, 1)), withMicro(lengthWords(gap.after, 1)),
      withMicro(lengthWords(gap.noise, 1)));
  if (!shrink.judged()) return left + notHeldOutWords();
  return left + fmt::format(
                    "On postures held out the rms shrinks by {0:.{4}f} % ({1:.{4}f} to {2:.{4}f} %), and {3} % of what "
                    "is above the noise is explained.",
                    100.0 * shrink.value, 100.0 * shrink.low, 100.0 * shrink.high, percentNumber(effects.explained, 0),
                    placesThatTell(100.0 * shrink.low, 100.0 * shrink.high));
}

namespace {

/// As the page says them: "bearing tilt (joints 2 to 6)".
std::string addedWords(const extended_model::EffectFit& effects) {
  std::vector<std::string> names;
  for (const extended_model::AddedEffect& one : effects.added) {
    const std::string name = effectName(one.effect);
    names.push_back(one.detail.empty() ? name : fmt::format("{} ({})", name, shortDetail(one.detail)));
  }
  return fmt::format("{}", fmt::join(names, " and "));
}

}  // namespace

std::string budgetKey(const extended_model::BudgetLine& line) {
  using extended_model::BudgetSource;
  switch (line.source) {
    case BudgetSource::scatter:
      return "scatter";
    case BudgetSource::frames:
      return "frames";
    case BudgetSource::wrist:
      return "wrist";
    case BudgetSource::geometry:
      return "geometry";
    case BudgetSource::effect:
      return std::string(effects::idOf(*line.effect));
    case BudgetSource::correlation:
      return "correlation_of_effects";
    case BudgetSource::load_cell_gain:
      return "load_cell_gain";
    case BudgetSource::masses:
      return "masses";
    case BudgetSource::tracker_scale:
      return "tracker_scale";
    case BudgetSource::standing_load:
      return "standing_load";
    case BudgetSource::over_day:
      return "over_day";
    case BudgetSource::apparent:
      return "apparent";
  }
  return {};
}

std::string budgetWords(const extended_model::BudgetLine& line) {
  using extended_model::BudgetSource;
  switch (line.source) {
    case BudgetSource::scatter:
      return "scatter between postures";
    case BudgetSource::frames:
      return "measured axes";
    case BudgetSource::wrist:
      return "radii about the wrist";
    case BudgetSource::geometry:
      return "calibrated geometry";
    case BudgetSource::effect:
      return fmt::format("{}, {}", effectName(*line.effect),
                         line.in_model ? "as fitted" : (line.declared ? "as declared" : "could hide"));
    case BudgetSource::correlation:
      return "effects in common";
    case BudgetSource::load_cell_gain:
      return "load cell's scale";
    case BudgetSource::masses:
      return "masses, as declared";
    case BudgetSource::tracker_scale:
      return "tracker's scale, as declared";
    case BudgetSource::standing_load:
      return "moves while a load stands";
    case BudgetSource::over_day:
      return "changes over the day";
    case BudgetSource::apparent:
      return "no model explains the gap";
  }
  return {};
}

std::string combinationWords(const extended_model::SeenCombination& seen) {
  constexpr double kNano = 1e-9;
  const std::string unit = seen.parameter.unit.empty() ? "" : ", " + seen.parameter.unit;
  const double value = seen.value / kNano, u = expanded(seen.sd) / kNano;
  const int places = u > 0.0 ? std::max(0, 1 - static_cast<int>(std::floor(std::log10(u)))) : 1;
  return fmt::format(
      "1/k{0} and {1} ({2}{3}) are hardly told apart; known is 1/k{0} {4} {5:.3g} times that: ({6:.{8}f} +- {7:.{8}f}) "
      "1e-9 rad/Nm (U, 95 %)",
      seen.joint + 1, effectName(seen.parameter.effect), seen.parameter.name, unit, seen.ratio < 0.0 ? "-" : "+",
      std::abs(seen.ratio), value, u, places);
}

std::string residualWords(const extended_model::ExtendedModel& model) {
  const extended_model::HiddenEffects& hidden = *model.hidden;
  std::string text = fmt::format("Joint springs alone leave {:.3g} times the noise's chi-square", hidden.lack_of_fit);
  // What was taken off the readings before counts as noise, too, so that less than nothing can be left.
  if (!model.effects.added.empty())
    text += hidden.left_over > 0.0 ? fmt::format(", the model {:.3g}", hidden.left_over) : ", the model less than it";
  // What no effect explains has become noise to the fit: without that a reader holds the figure against the tracker's.
  if (model.study && model.study->fit.state.model_error > 0.0)
    text += fmt::format(" (noise is the tracker's and, once a posture, {} at the largest load that no effect explains)",
                        withMicro(lengthWords(model.study->fit.state.model_error, 1)));
  if (hidden.unexplained)
    return text + fmt::format(
                      "; {:.0f} % of the gap is explained by no effect that is known here: values are apparent "
                      "ones, and the intervals hold what springs alone say, too.",
                      100.0 * hidden.unexplained_share);
  if (!model.residualIsNoise()) return text + "; what is left is more than noise, and in the scatter between postures.";
  return text + "; 1 is noise.";
}

std::string gainWords(const extended_model::ExtendedModel& model) {
  if (model.effects.added.empty()) {
    std::string text = "No effect was added to the joint springs.";
    for (const std::string& note : words(model.effects.notes)) text += " Note: " + note + ".";
    return text;
  }
  const identification::Method which = identification::bestMethod(model.with);
  const identification::MethodResult &without = model.without.of(which), &with = model.with.of(which);
  if (!without.available || !with.available)
    return fmt::format("With {} in the model no method can be compared.", addedWords(model.effects));
  const auto share = [](const identification::MethodResult& method) {
    return percentNumber(
        method.subsets.compliances.empty() ? method.at_targets->all_postures : method.at_targets->subsets.held_out, 1);
  };
  const double left = with.estimate.rms_residual / io::kMicrometre,
               before = without.estimate.rms_residual / io::kMicrometre;
  const std::string held_out = with.subsets.compliances.empty() ? "" : " in postures held out";
  std::string text = fmt::format("With {} in the model {} leaves ", addedWords(model.effects), namesOf(which).brief);
  // Numbers that print alike would say "8 instead of 8".
  const int decimals = fixed(left, 0) == fixed(before, 0) ? 1 : 0;
  if (fixed(left, decimals) == fixed(before, decimals))
    text += fmt::format("{} µm rms per coordinate as without", fixed(left, decimals));
  else
    text += fmt::format("{} µm rms per coordinate instead of {} µm", fixed(left, decimals), fixed(before, decimals));
  if (share(with) == share(without))
    return text + fmt::format(", and compensates {}\u00a0% of the reflectors' deflection{}, with it or without.",
                              share(with), held_out);
  return text + fmt::format(", and compensates {}\u00a0% instead of {}\u00a0% of the reflectors' deflection{}.",
                            share(with), share(without), held_out);
}

std::string doubtOf(const extended_model::AddedEffect& effect) {
  if (!effect.plausible) return "its size is beyond what a machine can have: do not believe it";
  constexpr double kStandsOut = 20.0;  // of BIC, the diagnosis's own limit
  if (effect.score < kStandsOut)
    return fmt::format(
        "it does not stand out of the noise here (a fall of BIC of {:.1f}, {:.0f} would count): it was added "
        "because it was asked for",
        effect.score, kStandsOut);
  return {};
}

}  // namespace stiffscope::reports
