#pragma once

#include "core/diagnosis/effect_model.h"

namespace stiffscope {

/// Lost motion as a joint's torque passes zero: theta_j += b_j/2 tanh(tau_j / w), tau_j of own weight and load together.
/// Parameters: b_j (rad, never negative), the whole play of each joint, at most 20 mrad; and, once they are known, a step
/// of the width w (Nm) over which the passage is rounded.
EffectModel backlash();

}  // namespace stiffscope
