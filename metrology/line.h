#pragma once

#include <Eigen/Core>

namespace stiffscope {

/// An infinite, directed line: a joint axis, or the intersection of two planes.
/// `point` is any point on it (m), `direction` has unit length; both in one frame that the name of the
/// variable states (`axes_in_base`).
struct Line {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};

}  // namespace stiffscope
