#pragma once

#include <string>

#include "core/diagnosis/effect_model.h"

namespace stiffscope {

/// What parameter `k` of a part is called, and its unit: "joint 3", "P12 x", "1/EI of link 2", "turn about x".
std::string parameterName(const EffectModel& model, const EffectPart& part, std::size_t k);
std::string parameterUnit(const EffectPart& part, std::size_t k);

}  // namespace stiffscope
