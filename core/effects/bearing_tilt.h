#pragma once

#include "core/effects/effect_model.h"

namespace stiffscope::effects {

/// A joint also gives about the two directions across its axis (moment compliance of its main bearing, alike
/// in both): rotation s (M - z (z.M)) about the joint origin, M what the joint carries there (own weight and
/// load), z the axis. s in rad/Nm, never negative; at most 1e-5, a bearing a hundred times softer than a
/// light arm's. Source: bearing catalogues (moment rigidity of crossed-roller and angular bearings).
EffectModel bearingTilt();

}  // namespace stiffscope::effects
