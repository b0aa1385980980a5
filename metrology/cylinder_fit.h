#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "metrology/lines.h"
#include "metrology/measured_points.h"

namespace stiffscope::metrology {

struct Cylinder {
  Line axis;
  double radius = 0.0;
};

/// `cylinder.axis.point` is the point of the axis nearest to the points' mean, the largest component of its
/// direction is positive.
struct FittedCylinder : FitQuality {
  static constexpr std::array kParameters{"point_x", "point_y", "point_z", "axis_x", "axis_y", "axis_z", "radius"};
  Cylinder cylinder;
  /// Covariance of (point, direction, radius), rank 5: the point has no uncertainty along the axis, the unit vector
  /// none in its length.
  std::optional<Eigen::Matrix<double, 7, 7>> covariance;
};

/// Least squares of the radial residuals rho - r, over 5 degrees of freedom (n - 5 are left), weighted by the
/// variance along the radius where covariances are given. Several directions are local minima: Gauss-Newton
/// starts from each that an algebraic search over the half sphere finds, and the
/// least sum is taken. Undetermined: fewer than five places, points in one plane or on one line, a curvature
/// or direction that is not significant against the scatter, two different cylinders that fit alike.
FittedCylinder fitCylinder(const MeasuredPoints& points);

}  // namespace stiffscope::metrology
