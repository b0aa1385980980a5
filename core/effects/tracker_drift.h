#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// Readings wander with time: a rigid motion that grows with the time since the sweeps, rotation about the
/// middle of the readings and shift, in rad and m over the whole of the loading.
EffectModel trackerDrift();

}  // namespace stiffscope::effects
