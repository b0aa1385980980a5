#pragma once

#include "core/robot/kinematics.h"
#include "core/statics/wrench.h"

namespace stiffscope {

/// Joint torques of a wrench on the flange, paper (2): Gamma = J_w^T W, J_w the Jacobian of the point about which the
/// wrench's moment is taken. The same whatever that point is. Nm.
Vector6d jointTorque(const ArmAxes& axes, const Wrench& wrench_in_base);
Vector6d jointTorque(const Robot& robot, const ArmPosture& posture, const Wrench& wrench_in_base);

}  // namespace stiffscope
