#pragma once

#include <Eigen/Core>

namespace stiffscope {

/// R = Rz(yaw) Ry(pitch) Rx(roll): turns about the fixed x, y, z axes in that order, as URDF has them (rad).
Eigen::Matrix3d rotationFromRpy(const Eigen::Vector3d& rpy);

/// Inverse of rotationFromRpy, pitch within +-90 deg; at +-90 deg, where only roll -+ yaw is determined, roll
/// is 0.
Eigen::Vector3d rpyFromRotation(const Eigen::Matrix3d& rotation);

}  // namespace stiffscope
