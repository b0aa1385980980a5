#pragma once

#include "core/robot/gravity_load.h"
#include "core/robot/kinematics.h"
#include "core/robot/wrench.h"

namespace stiffscope::robot {

/// K_c of paper (4): how the joint torques of dead loads change as the joints deflect, K_c = d(J_w^T W)/d theta,
/// Nm/rad. Forces keep their direction in the base frame and act at points that move with their body; for joints a <= b
/// the entry is z_a . ((z_b x (x - p_b)) x F), the Hessian of the load's potential. A moment keeps its direction too.
/// Of coupled joints turns^T K_c turns by the axes' K_c.
JointMatrix geometricStiffness(const ArmAxes& axes, const Wrench& wrench_in_base);

/// The share of K_c that the own weight and the balancers have; `axes` are those at that posture.
JointMatrix geometricStiffness(const ArmAxes& axes, const ArmPosture& posture, const GravityLoad& weight);

}  // namespace stiffscope::robot
