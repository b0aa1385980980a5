#include "core/robot/kinematics.h"

#include <Eigen/Geometry>
#include <cmath>

namespace stiffscope::robot {

Eigen::Matrix3d rotationFromRpy(const Eigen::Vector3d& rpy) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return (AngleAxisd(rpy.z(), Vector3d::UnitZ()) * AngleAxisd(rpy.y(), Vector3d::UnitY()) *
          AngleAxisd(rpy.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d rpyFromRotation(const Eigen::Matrix3d& r) {
  // cos(pitch); below the limit roll and yaw turn about the same line and rounding alone would split them.
  const double across = std::hypot(r(0, 0), r(1, 0));
  const double pitch = std::atan2(-r(2, 0), across);
  if (across < 1e-9) return {0.0, pitch, std::atan2(-r(0, 1), r(1, 1))};
  return {std::atan2(r(2, 1), r(2, 2)), pitch, std::atan2(r(1, 0), r(0, 0))};
}

ArmPosture postureAt(const Robot& robot, const Vector6d& q) {
  return postureAt(robot.axes_in_base_at_zero, q, Eigen::Isometry3d::Identity());
}

ArmPosture postureAt(const ArmAxes& axes_at_zero, const Vector6d& q, const Eigen::Isometry3d& base) {
  ArmPosture posture;
  posture.motion[0] = base;
  for (int joint = 0; joint < 6; ++joint) {
    const metrology::Line& axis = axes_at_zero[static_cast<std::size_t>(joint)];
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(q[joint], axis.direction).toRotationMatrix();
    const Eigen::Isometry3d& before = posture.motion[static_cast<std::size_t>(joint)];
    Eigen::Isometry3d& after = posture.motion[static_cast<std::size_t>(joint) + 1];
    after.linear() = before.linear() * turn;
    after.translation() = before.linear() * (axis.point - turn * axis.point) + before.translation();
    after.makeAffine();
  }
  return posture;
}

metrology::Line axisAt(const Robot& robot, const ArmPosture& posture, int joint) {
  const metrology::Line& axis = robot.axes_in_base_at_zero[static_cast<std::size_t>(joint)];
  const Eigen::Isometry3d& motion = posture.motion[static_cast<std::size_t>(joint)];
  return {motion * axis.point, motion.linear() * axis.direction};
}

ArmAxes axesAt(const Robot& robot, const ArmPosture& posture) {
  ArmAxes axes;
  for (int joint = 0; joint < 6; ++joint) axes[static_cast<std::size_t>(joint)] = axisAt(robot, posture, joint);
  return axes;
}

Eigen::Isometry3d flangeAt(const Robot& robot, const ArmPosture& posture) {
  return posture.motion[6] * robot.base_from_flange_at_zero;
}

Matrix6d jacobianAt(const Robot& robot, const ArmPosture& posture, const Eigen::Vector3d& point_in_base) {
  return jacobianAt(axesAt(robot, posture), point_in_base);
}

Matrix6d jacobianAt(const ArmAxes& axes, const Eigen::Vector3d& point_in_base) {
  Matrix6d jacobian;
  jacobian.topRows<3>() = pointJacobianAt(axes, point_in_base);
  for (int joint = 0; joint < 6; ++joint) {
    jacobian.col(joint).tail<3>() = axes[static_cast<std::size_t>(joint)].direction;
  }
  return jacobian;
}

Matrix36d pointJacobianAt(const ArmAxes& axes, const Eigen::Vector3d& point_in_base) {
  Matrix36d jacobian;
  for (int joint = 0; joint < 6; ++joint) {
    const metrology::Line& axis = axes[static_cast<std::size_t>(joint)];
    jacobian.col(joint) = axis.direction.cross(point_in_base - axis.point);
  }
  return jacobian;
}

}  // namespace stiffscope::robot
