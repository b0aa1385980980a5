#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/robot/robot.h"

namespace stiffscope::robot {

/// R = Rz(yaw) Ry(pitch) Rx(roll): turns about the fixed x, y, z axes in that order, as URDF has them (rad).
Eigen::Matrix3d rotationFromRpy(const Eigen::Vector3d& rpy);

/// Inverse of rotationFromRpy, pitch within +-90 deg; at +-90 deg, where only roll -+ yaw is determined, roll
/// is 0.
Eigen::Vector3d rpyFromRotation(const Eigen::Matrix3d& rotation);

/// How far each body of the arm has moved from its place at all joints zero: a point fixed to body b that
/// stands at x (base frame) when all joints are zero stands at motion[b] * x now. motion[0] is the identity.
struct ArmPosture {
  PerBody<Eigen::Isometry3d> motion;
};

/// Rigid forward kinematics: motion[b] = exp(xi_1 theta_1) ... exp(xi_b theta_b), theta the axes' angles at joint
/// angles q, rad.
ArmPosture postureAt(const Robot& robot, const JointVector& q);

/// Forward kinematics of axes at zero, with all bodies carried along by a motion of the base, which is motion[0].
ArmPosture postureAt(const ArmAxes& axes_at_zero, const JointVector& q, const Eigen::Isometry3d& base);

/// Axis `axis` (from 0) in the base frame at this posture.
metrology::Line axisAt(const Robot& robot, const ArmPosture& posture, int axis);

/// All of them: what Jacobians of several points at one posture have in common.
ArmAxes axesAt(const Robot& robot, const ArmPosture& posture);

/// base_from_flange at this posture.
Eigen::Isometry3d flangeAt(const Robot& robot, const ArmPosture& posture);

/// Jacobian of a point of the flange body, paper (1): rows 0-2 the velocity of the point at `point_in_base`,
/// rows 3-5 the angular velocity, both in base axes; column j is [z_j x (p - p_j); z_j], of coupled joints the sum over
/// the axes that joint j turns, each times its turn.
Jacobian jacobianAt(const ArmAxes& axes, const Eigen::Vector3d& point_in_base);
Jacobian jacobianAt(const Robot& robot, const ArmPosture& posture, const Eigen::Vector3d& point_in_base);

/// Its rows 0-2, by the axes at that posture.
PointJacobian pointJacobianAt(const ArmAxes& axes, const Eigen::Vector3d& point_in_base);

}  // namespace stiffscope::robot
