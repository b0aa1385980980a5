#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// The load acts elsewhere on the tool than declared: its point is off by r in flange axes, which changes the
/// moment by (R r) x F; the springs turn accordingly. r in m, at most 0.3 m each way. Bilinear with the
/// compliances.
EffectModel loadPointError();

}  // namespace stiffscope::effects
