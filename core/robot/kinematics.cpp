#include "core/robot/kinematics.h"

namespace stiffscope {

ArmPosture postureAt(const Robot& robot, const Vector6d& q) {
  ArmPosture posture;
  posture.motion[0].setIdentity();
  for (int joint = 0; joint < 6; ++joint) {
    const Line& axis = robot.axes_in_base_at_zero[static_cast<std::size_t>(joint)];
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(q[joint], axis.direction).toRotationMatrix();
    const Eigen::Isometry3d& before = posture.motion[static_cast<std::size_t>(joint)];
    Eigen::Isometry3d& after = posture.motion[static_cast<std::size_t>(joint) + 1];
    after.linear() = before.linear() * turn;
    after.translation() = before.linear() * (axis.point - turn * axis.point) + before.translation();
    after.makeAffine();
  }
  return posture;
}

Line axisAt(const Robot& robot, const ArmPosture& posture, int joint) {
  const Line& axis = robot.axes_in_base_at_zero[static_cast<std::size_t>(joint)];
  const Eigen::Isometry3d& motion = posture.motion[static_cast<std::size_t>(joint)];
  return {motion * axis.point, motion.linear() * axis.direction};
}

Eigen::Isometry3d flangeAt(const Robot& robot, const ArmPosture& posture) {
  return posture.motion[6] * robot.base_from_flange_at_zero;
}

Matrix6d jacobianAt(const Robot& robot, const ArmPosture& posture, const Eigen::Vector3d& point_in_base) {
  Matrix6d jacobian;
  for (int joint = 0; joint < 6; ++joint) {
    const Line axis = axisAt(robot, posture, joint);
    jacobian.col(joint) << axis.direction.cross(point_in_base - axis.point), axis.direction;
  }
  return jacobian;
}

}  // namespace stiffscope
