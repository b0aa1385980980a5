#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "metrology/lines.h"
#include "metrology/measured_points.h"

namespace stiffscope::metrology {

/// A straight line through points. `line.point` is the point of the line nearest to the points' mean, the
/// largest component of `line.direction` is positive.
struct FittedLine : FitQuality {
  static constexpr std::array kParameters{"point_x", "point_y", "point_z", "axis_x", "axis_y", "axis_z"};
  Line line;
  /// Covariance of (point, direction), rank 4: the point has no uncertainty along the line, the unit vector none in its
  /// length.
  std::optional<Eigen::Matrix<double, 6, 6>> covariance;
};

/// Least squares of the orthogonal distances, both components across the line: sum of |(p - q) x d|^2, over 4
/// degrees of freedom (2 n - 4 are left). Unweighted it is the first principal axis; covariances weight each
/// point by those of its two components. Undetermined: fewer than two places, no direction in which the
/// points spread most, or, against their scatter, hardly.
FittedLine fitLine(const MeasuredPoints& points);

}  // namespace stiffscope::metrology
