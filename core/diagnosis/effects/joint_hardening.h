#pragma once

#include "core/diagnosis/effect_model.h"

namespace stiffscope {

/// Stiffness grows (or drops) with torque: theta_j = c_j tau - h_j tau^3 (even stiffness k(tau), first term of its series),
/// or, the other usual form, theta_j = c_j tau - h_j tau |tau|; tau of own weight and load together. Parameters h_j
/// of either sign, one a joint: rad/Nm^3 or rad/Nm^2.
EffectModel jointHardening();
EffectModel jointHardeningLinear();

}  // namespace stiffscope
