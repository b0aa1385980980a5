#pragma once

#include <string>

#include "core/identification/loaded_arm.h"

namespace stiffscope {

// Why a method cannot be had, and what measurement would make it available; empty where nothing stands in
// its way.

/// What all methods need: postures read unloaded and loaded, placed in R0, and a joint that the load turns.
std::string whyNoPositions(const Campaign& campaign, const LoadedArm& arm, const JointMask& unknown);

/// Complete Pose: the flange's pose in every posture. The arm has cases.
std::string whyNoFlangePoses(const Campaign& campaign, const LoadedArm& arm);

/// Decoupled Partial Pose: P_wrist in every posture.
std::string whyNoWristPoint(const Campaign& campaign, const LoadedArm& arm, const WristCentre& wrist);

/// Decoupled Partial Pose: axes that meet nearly enough; `leak` is wristLeak's share.
std::string whyNotDecoupled(const WristCentre& wrist, double leak);

}  // namespace stiffscope
