#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "metrology/measured_points.h"

namespace stiffscope::metrology {

/// The plane through `point` across `normal` (unit length).
struct Plane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// `plane.point` is the point of the plane nearest to the points' mean, the largest component of the normal
/// is positive.
struct FittedPlane : FitQuality {
  static constexpr std::array kParameters{"point_x", "point_y", "point_z", "normal_x", "normal_y", "normal_z"};
  Plane plane;
  /// Covariance of (point, normal), rank 3: the point has uncertainty along the normal only, the unit vector none in
  /// its length.
  std::optional<Eigen::Matrix<double, 6, 6>> covariance;
};

/// Least squares of the distances n.(p - q), over 3 degrees of freedom (n - 3 are left). Unweighted it is the
/// plane across the last principal axis; covariances weight each point by its variance along the normal.
/// Undetermined: points on one line (exactly, or within their scatter), or no direction in which they spread
/// least.
FittedPlane fitPlane(const MeasuredPoints& points);

}  // namespace stiffscope::metrology
