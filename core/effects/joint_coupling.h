#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// Torque at one joint turns another: a compliance c_ab off the diagonal, theta_a += c_ab tau_b, theta_b +=
/// c_ab tau_a (symmetric by Maxwell and Betti), one for each of the fifteen pairs; of either sign, rad/Nm.
/// Torques of own weight and load together.
EffectModel jointCoupling();

}  // namespace stiffscope::effects
