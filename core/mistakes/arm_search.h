#pragma once

#include "core/campaign/campaign.h"
#include "core/mistakes/arm_cure.h"

namespace stiffscope::mistakes {

/// Looks whether postures have each other's angles; tries the table of mistakes (arm_mistakes.h) in all tables, in some
/// of them, at one posture or sweep; then pairs of them; then a joint's zero, a link of the URDF and the scale, which
/// have a size of their own. Nothing is tried where the readings are within `limits.suspicious` of the arm. A cure has
/// to bring them to a quarter of what they miss it by.
ArmSearch searchArm(const campaign::Campaign& campaign, const ReadingsOfDay& day, const SearchLimits& limits = {});

}  // namespace stiffscope::mistakes
