#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// Pedestal or floor gives: rotation about the two horizontal axes of base_link through its origin by the
/// moment there, and shifts along its three axes by the force (own weight and load). Its turn about the
/// vertical is joint 1's own compliance. Parameters: rocking about x, about y (rad/Nm), shift along x, y, z
/// (m/N); never negative.
EffectModel baseCompliance();

}  // namespace stiffscope::effects
