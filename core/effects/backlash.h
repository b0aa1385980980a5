#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// Lost motion as a joint's torque passes zero: theta_j += b_j/2 tanh(tau_j / (w T_j)), tau_j of own weight
/// and load together, T_j the largest the joint sees. Parameters: b_j (rad, never negative), the whole play of
/// each joint, at most 20 mrad; and, once they are known, a step of the width w over which the passage is
/// rounded, one for all joints.
EffectModel backlash();

}  // namespace stiffscope::effects
