#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// The tracker, or the robot, moved between the frame sweeps and the loading: every reading of the loading is
/// shifted by a small rigid motion, rotation about the middle of the readings (rad), then shift (m). It shows
/// in absolute positions, not in the sweeps; a deflection does not see it.
EffectModel frameError();

}  // namespace stiffscope::effects
