#pragma once

#include <string>

#include "core/extended_model/extended_model.h"

namespace stiffscope::reports {

/// "bearing_tilt (joint 3) and load_point_error"; "nothing" where no effect was added.
std::string addedNames(const extended_model::EffectFit& effects);

/// What the effects explain of the gap, in a sentence.
std::string explainedWords(const extended_model::EffectFit& effects);

/// "With bearing_tilt (joint 3) in the model DPP leaves 9 µm rms instead of 42 µm, and compensates ..."; by
/// the method that stands for the campaign. Where nothing was added, that and why.
std::string gainWords(const extended_model::ExtendedModel& model);

/// What a line of the budget stands for: "scatter between postures", "bearing tilt, fitted", "backlash, could hide".
std::string budgetWords(const extended_model::BudgetLine& line);
/// Its key in JSON and CSV.
std::string budgetKey(const extended_model::BudgetLine& line);

/// "1/k4 and link compliance (1/GJ of link 3, 1/Nm2) are hardly told apart; known is 1/k4 + 0.8 times that: (3000 +-
/// 20) 1e-9 rad/Nm (U, 95 %)".
std::string combinationWords(const extended_model::SeenCombination& seen);

/// What springs alone and the model leave of the readings, in multiples of the noise, and whether that is explained:
/// said whatever the sizes are.
std::string residualWords(const extended_model::ExtendedModel& model);

/// What an effect came out as that a reader must know: beyond its bounds, or within the noise; empty where neither.
std::string doubtOf(const extended_model::AddedEffect& effect);

}  // namespace stiffscope::reports
