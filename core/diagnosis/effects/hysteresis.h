#pragma once

#include "core/diagnosis/effect_model.h"

namespace stiffscope {

/// Friction: the way back differs from the way out. Each joint is a spring behind a dry friction f_j (Nm), the play
/// operator (Prandtl-Ishlinskii; Coulomb): its spring torque x follows the load torque as x <- clamp(x, tau - f, tau + f)
/// from one load step to the next, x = 0 unloaded; theta_j = c_j x. Parameter b_j = c_j f_j (rad, never negative):
/// the lag once the joint has slipped. The shape depends on f_j: the working point has it, 0 meaning small.
EffectModel hysteresis();

}  // namespace stiffscope
