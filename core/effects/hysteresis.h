#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// Friction: the way back differs from the way out. Each joint is a spring behind a dry friction f_j (Nm),
/// the play operator (Prandtl-Ishlinskii; Coulomb): its spring torque x follows the load torque as x <-
/// clamp(x, tau - f, tau + f) from one load step to the next, x = 0 unloaded; theta_j = c_j x. Parameter b_j
/// = c_j f_j (rad, never negative): the lag once the joint has slipped. The shape depends on f_j: the working
/// point has it, 0 meaning small.
///
/// Friction that grips by a spring of its own before it slips (Jenkins; many sliders: Iwan 1966), beside the
/// joint's: theta_j = c_j (tau - sum_s g_s), g_s <- clamp(g_s + r k_j / n dtheta, -f_s, f_s), with f_s evenly
/// spread from little to twice the mean and their sum f_j. The seventh parameter is a step of the logarithm
/// of r, one for all joints, about the working point's.
EffectModel hysteresis();
EffectModel hysteresisOneSlider();
EffectModel hysteresisManySliders();

}  // namespace stiffscope::effects
