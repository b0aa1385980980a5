#pragma once

#include "core/identification/complete_pose.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope {

// Normal equations of all cases of a loaded arm, summed as their rows are made: for where compliances alone are wanted,
// many times over.

/// Of reflectorEquations, wristPointEquations and poseEquations (loaded_arm.h).
NormalEquations reflectorNormal(const LoadedArm& arm);
NormalEquations wristNormal(const LoadedArm& arm);
PoseNormal poseNormal(const LoadedArm& arm, const Eigen::Vector3d& tcp_in_flange);

}  // namespace stiffscope
