#pragma once

#include "core/diagnosis/effect_model.h"

namespace stiffscope {

/// One reflector moves in its nest under load, in flange axes: in proportion to the force, or by a step as soon as it is
/// loaded. Parameters: the shift at the campaign's largest force (m, at most 5 mm each way), three a reflector.
EffectModel targetMotion(const std::vector<std::string>& targets);
EffectModel targetSlip(const std::vector<std::string>& targets);

}  // namespace stiffscope
