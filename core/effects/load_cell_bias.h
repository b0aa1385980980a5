#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// A constant force added to, or missing from, the readings of loaded states (not of unloaded ones or of
/// returns to zero): the true force is the reading plus b. Constant in the cell's axes (an amplifier's zero),
/// or constant along gravity (a shackle that hangs with the load and was not weighed). b in N, at most 2 kN.
/// Bilinear with the compliances.
EffectModel loadCellBias();
EffectModel loadCellMissingWeight();

}  // namespace stiffscope::effects
