#pragma once

#include <Eigen/Geometry>

namespace stiffscope {

/// The rigid motion of a rotation vector and a displacement at `centre`.
Eigen::Isometry3d motionAbout(const Eigen::Vector3d& centre, const Eigen::Matrix<double, 6, 1>& motion);

}  // namespace stiffscope
