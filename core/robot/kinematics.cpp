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

ArmPosture postureAt(const Robot& robot, const JointVector& q) {
  return postureAt(robot.axes_in_base_at_zero, q, Eigen::Isometry3d::Identity());
}

ArmPosture postureAt(const ArmAxes& axes_at_zero, const JointVector& q, const Eigen::Isometry3d& base) {
  ArmPosture posture;
  posture.motion.push_back(base);
  const JointVector angles = axes_at_zero.angles(q);
  for (std::size_t i = 0; i < axes_at_zero.size(); ++i) {
    const metrology::Line& axis = axes_at_zero[i];
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angles[static_cast<Eigen::Index>(i)], axis.direction).toRotationMatrix();
    const Eigen::Isometry3d& before = posture.motion[i];
    Eigen::Isometry3d& after = posture.motion.emplace_back();
    after.linear() = before.linear() * turn;
    after.translation() = before.linear() * (axis.point - turn * axis.point) + before.translation();
    after.makeAffine();
  }
  return posture;
}

metrology::Line axisAt(const Robot& robot, const ArmPosture& posture, int axis) {
  const metrology::Line& at_zero = robot.axes_in_base_at_zero[static_cast<std::size_t>(axis)];
  const Eigen::Isometry3d& motion = posture.motion[static_cast<std::size_t>(axis)];
  return {motion * at_zero.point, motion.linear() * at_zero.direction};
}

ArmAxes axesAt(const Robot& robot, const ArmPosture& posture) {
  ArmAxes axes;
  axes.couplings = robot.axes_in_base_at_zero.couplings;
  for (int axis = 0; axis < robot.axes(); ++axis) axes.push_back(axisAt(robot, posture, axis));
  return axes;
}

Eigen::Isometry3d flangeAt(const Robot& robot, const ArmPosture& posture) {
  return posture.motion.back() * robot.base_from_flange_at_zero;
}

Jacobian jacobianAt(const Robot& robot, const ArmPosture& posture, const Eigen::Vector3d& point_in_base) {
  return jacobianAt(axesAt(robot, posture), point_in_base);
}

Jacobian jacobianAt(const ArmAxes& axes, const Eigen::Vector3d& point_in_base) {
  Jacobian jacobian(6, static_cast<Eigen::Index>(axes.size()));
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const metrology::Line& axis = axes[i];
    jacobian.col(static_cast<Eigen::Index>(i)) << axis.direction.cross(point_in_base - axis.point), axis.direction;
  }
  if (axes.couplings) jacobian = jacobian * axes.couplings->turns;
  return jacobian;
}

PointJacobian pointJacobianAt(const ArmAxes& axes, const Eigen::Vector3d& point_in_base) {
  PointJacobian jacobian(3, static_cast<Eigen::Index>(axes.size()));
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const metrology::Line& axis = axes[i];
    jacobian.col(static_cast<Eigen::Index>(i)) = axis.direction.cross(point_in_base - axis.point);
  }
  if (axes.couplings) jacobian = jacobian * axes.couplings->turns;
  return jacobian;
}

JointVector Couplings::angles(const JointVector& q) const { return turns * q; }

JointVector Couplings::torques(const JointVector& by_axis) const { return turns.transpose() * by_axis; }

bool ArmAxes::turnsAlone(int joint) const {
  return !couplings || (couplings->turns.col(joint).array() != 0.0).count() == 1;
}

Robot::Robot() = default;
Robot::Robot(const Robot&) = default;
Robot::Robot(Robot&&) noexcept = default;
Robot& Robot::operator=(const Robot&) = default;
Robot& Robot::operator=(Robot&&) noexcept = default;
Robot::~Robot() = default;

bool Robot::wristStandsApart() const {
  if (!coupled()) return true;
  const int arm = armJointsOf(joints());
  return axes_in_base_at_zero.couplings->turns.topRightCorner(armAxes(), joints() - arm).isZero(0.0);
}

}  // namespace stiffscope::robot
