#pragma once

#include <Eigen/Core>
#include <functional>

#include "metrology/measured_line.h"

namespace stiffscope {

/// Standard uncertainty of a number that depends on two independently measured lines, by the law of propagation
/// (GUM 5.1.2) with central differences over the eight parameters.
double propagatePair(const MeasuredLine& first, const MeasuredLine& second,
                     const std::function<double(const Line&, const Line&)>& number);

/// Of the length of their common perpendicular, m. Meant for a distance well above its uncertainty; for lines that
/// (nearly) meet it is the uncertainty of the signed miss along the common normal.
double distanceUncertainty(const MeasuredLine& first, const MeasuredLine& second);

/// Of the distance across the first line at a stated point (Hayati), m.
double distanceAcrossUncertainty(const MeasuredLine& first, const MeasuredLine& second,
                                 const Eigen::Vector3d& at_point);

/// Of the angle between them, rad. Where the lines are parallel within the uncertainty, that of the tilt.
double angleUncertainty(const MeasuredLine& first, const MeasuredLine& second);

}  // namespace stiffscope
