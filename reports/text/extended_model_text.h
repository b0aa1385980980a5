#pragma once

#include <string>

#include "core/extended_model/extended_model.h"

namespace stiffscope::reports {

/// What was added to the joint springs, with which sizes, what it explains, what is done with it.
std::string addedEffectsText(const extended_model::EffectFit& effects);

/// The same with each method without and with the effects: stiffnesses, residuals, shares compensated.
std::string improvedText(const extended_model::ImprovedModel& model, const std::vector<identification::Method>& methods);

}  // namespace stiffscope::reports
