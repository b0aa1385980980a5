#pragma once

#include <Eigen/Geometry>

#include "core/robot/kinematics.h"
#include "core/robot/robot.h"

namespace stiffscope::robot {

/// Force and moment in base axes, the moment taken about `point` (base frame). N, Nm, m.
struct Wrench {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();

  /// The same load, its moment taken about another point: M' = M + (point - other) x F.
  Wrench about(const Eigen::Vector3d& other) const { return {other, force, moment + (point - other).cross(force)}; }

  /// (30): force then moment.
  Vector6d vector() const { return (Vector6d() << force, moment).finished(); }
};

/// Joint torques of a wrench on the flange, paper (2): Gamma = J_w^T W, J_w the Jacobian of the point about which the
/// wrench's moment is taken. The same whatever that point is. Of coupled joints what the drive holds, turns^T by the
/// axes' torques. Nm.
JointVector jointTorque(const ArmAxes& axes, const Wrench& wrench_in_base);
JointVector jointTorque(const Robot& robot, const ArmPosture& posture, const Wrench& wrench_in_base);

}  // namespace stiffscope::robot
