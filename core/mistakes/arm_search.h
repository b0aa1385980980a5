#pragma once

#include "core/campaign/campaign.h"
#include "core/mistakes/arm_cure.h"

namespace stiffscope::mistakes {

/// Tries the table of mistakes (arm_mistakes.h) in all tables, in some of them, at one posture or sweep; then pairs of
/// them; then a joint's zero, a link of the URDF and the scale, which have a size of their own. Nothing is tried where
/// the readings are within kSuspicious of the arm. A cure has to bring them to a quarter of what they miss it by.
ArmSearch searchArm(const campaign::Campaign& campaign, const ReadingsOfDay& day);

/// Readings nearer than that to the URDF's arm are not searched, m: heavy arms without known masses sag by more, and
/// then no cure is found; errors of geometry of a calibrated day are a tenth of it.
inline constexpr double kSuspicious = 5e-3;

}  // namespace stiffscope::mistakes
