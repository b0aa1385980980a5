#pragma once

#include <Eigen/Core>

namespace stiffscope {

/// One-sigma noise of one laser-tracker reading: along the line of sight range_fixed + range_per_m d, in each
/// of the two directions across it angle_fixed + angle_per_m d, d the distance from the station. m, m per m.
struct TrackerNoise {
  double range_fixed = 0.0;
  double range_per_m = 0.0;
  double angle_fixed = 0.0;
  double angle_per_m = 0.0;
  Eigen::Vector3d station = Eigen::Vector3d::Zero();

  /// Covariance (m^2) of a reading at `point`, in the frame in which point and station are given.
  Eigen::Matrix3d covarianceAt(const Eigen::Vector3d& point) const;
};

}  // namespace stiffscope
