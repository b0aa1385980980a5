#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "metrology/measured_line.h"

namespace stiffscope {

using LinePairNumber = std::function<double(const Line&, const Line&)>;

/// The distance of two lines with a sign, along their common normal as it stands now: near these two lines it is
/// their distance, and unlike that it is smooth where they meet. Not for parallel lines.
LinePairNumber signedDistance(const Line& first, const Line& second);

/// The angle between two lines as the tilt about `normal`: the angle has no derivative where it is 0, the tilt has.
LinePairNumber tiltAbout(const Eigen::Vector3d& normal);

/// The common normal about which the angle of two lines is their tilt; exactly parallel lines have none: empty.
std::optional<Eigen::Vector3d> commonNormal(const Line& first, const Line& second);

/// Standard uncertainty of a number that depends on two independently measured lines, by the law of propagation
/// (GUM 5.1.2) with central differences over the eight parameters.
double propagatePair(const MeasuredLine& first, const MeasuredLine& second,
                     const LinePairNumber& number);

/// Of the length of their common perpendicular, m. Meant for a distance well above its uncertainty; for lines that
/// (nearly) meet it is the uncertainty of the signed miss along the common normal.
double distanceUncertainty(const MeasuredLine& first, const MeasuredLine& second);

/// Of the distance across the first line at a stated point (Hayati), m.
double distanceAcrossUncertainty(const MeasuredLine& first, const MeasuredLine& second,
                                 const Eigen::Vector3d& at_point);

/// Of the angle between them, rad. Where the lines are parallel within the uncertainty, that of the tilt.
double angleUncertainty(const MeasuredLine& first, const MeasuredLine& second);

}  // namespace stiffscope
