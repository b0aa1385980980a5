#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// The load cell is turned against its declared axes by a small rotation w (flange axes, rad, at most 0.3):
/// force and moment are in truth (I + w x) of what was read. Bilinear with the compliances.
EffectModel loadCellMisalignment();

}  // namespace stiffscope::effects
