#pragma once

#include <Eigen/Core>

#include "metrology/line.h"

namespace stiffscope {

/// The shortest segment between two lines.
struct CommonPerpendicular {
  Eigen::Vector3d foot_on_first;
  Eigen::Vector3d foot_on_second;
  double distance = 0.0;  ///< between the feet, m
  double angle = 0.0;     ///< between the lines, rad, 0..pi/2
};

/// Feet are undetermined for parallel lines and ill-determined near that: for lines within a degree of parallel
/// use distanceAcross at a stated point instead (Hayati's convention).
CommonPerpendicular commonPerpendicular(const Line& first, const Line& second);

/// Distance from `at_point` on the first line to the second line's piercing point through the plane normal to
/// the first line at that point (m). Stays well determined when the lines are parallel.
double distanceAcross(const Line& first, const Line& second, const Eigen::Vector3d& at_point);

/// Angle between two lines, rad, 0..pi/2; accurate for small angles too.
double angleBetween(const Line& first, const Line& second);

/// The point of the line nearest to `point`.
Eigen::Vector3d nearestPoint(const Line& line, const Eigen::Vector3d& point);

}  // namespace stiffscope
