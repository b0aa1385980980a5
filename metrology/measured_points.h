#pragma once

#include <Eigen/Core>
#include <vector>

namespace stiffscope {

/// Readings of points in one frame. `covariances` is empty, or one a point, in the square of the points'
/// unit.
struct MeasuredPoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Matrix3d> covariances;
};

}  // namespace stiffscope
