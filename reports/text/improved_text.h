#pragma once

#include <string>

#include "core/improved/improved_model.h"

namespace stiffscope {

/// What was added to the joint springs, with which sizes, what it explains, what is done with it.
std::string addedEffectsText(const EffectFit& effects);

/// The same with each method without and with the effects: stiffnesses, residuals, shares compensated.
std::string improvedText(const ImprovedModel& model, const std::vector<Method>& methods);

}  // namespace stiffscope
