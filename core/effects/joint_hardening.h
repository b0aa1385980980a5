#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// Stiffness grows (or drops) with torque: theta_j = c_j tau - h_j tau^3 (even stiffness k(tau), first term
/// of its series), or, the other usual form, theta_j = c_j tau - h_j tau |tau|; tau of own weight and load
/// together. Parameters h_j of either sign, one a joint: rad/Nm^3 or rad/Nm^2. The further forms are whole
/// where the first two are the start of a series: a spring tau = k theta + k_3 theta^3, of which theta = c
/// tau g, g + a tau^2 g^3 = 1; and stiffnesses k (1 + a tau^2), k (1 + a |tau|). Their h_j = c_j a_j; the
/// shape takes a_j from the working point.
///
/// By stages, as gear makers' catalogues give it: theta_j = c_j tau - sum_b h_jb sign(tau) max(|tau| - t_b, 0),
/// six knots t_b evenly up to the largest torque T the joint sees; h_jb in rad/Nm. By a smooth curve: the compliance
/// is continuous and its slope is by stages, theta_j = c_j tau - sum_b h_jb sign(tau) max(|tau| - t_b, 0)^2 / (2 T),
/// knots at 0, T/8, T/4, T/2, closer where gears give way at their first loads; closer still they would pass for backlash.
EffectModel jointHardening();
EffectModel jointHardeningLinear();
EffectModel jointHardeningCubicSpring();
EffectModel jointHardeningWhole();
EffectModel jointHardeningLinearWhole();
EffectModel jointHardeningByStages();
EffectModel jointHardeningSmooth();

}  // namespace stiffscope::effects
