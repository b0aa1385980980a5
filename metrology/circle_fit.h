#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "metrology/measured_points.h"

namespace stiffscope::metrology {

/// A circle in space; `normal` has unit length.
struct Circle {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double radius = 0.0;
};

/// The largest component of the normal is positive.
struct FittedCircle : FitQuality {
  static constexpr std::array kParameters{"center_x", "center_y", "center_z", "normal_x",
                                          "normal_y", "normal_z", "radius"};
  Circle circle;
  std::optional<Eigen::Matrix<double, 7, 7>> covariance;  ///< of (centre, normal, radius), rank 6
};

enum class CircleStrategy {
  full,        ///< distances in space: radial and axial residuals together
  plane_first  ///< the points' plane, then the circle of the points projected on it (NIST's strategy 1)
};

/// Least squares of the orthogonal distances from a circle in space, sum of (rho - r)^2 + h^2 with rho and h
/// the radius and height of a point about the circle's axis, over 6 degrees of freedom (2 n - 6 are left); or
/// of the two parts one after the other. Covariances weight each point by that of its (radial, axial)
/// residuals, in the second strategy by the variance of each alone; its covariance keeps what the two parts
/// have in common. Start: plane of the last principal axis, Taubin's circle in it. The two strategies differ
/// in the second order of scatter over radius. Undetermined: fewer than three places, points on one line
/// (exactly or within their scatter), an arc whose curvature is not significant against the scatter.
FittedCircle fitCircle(const MeasuredPoints& points, CircleStrategy strategy = CircleStrategy::full);

}  // namespace stiffscope::metrology
