#pragma once

#include "metrology/measured_points.h"

namespace stiffscope::frames {

/// Covariance of one tracker reading at a point of R0, in R0, m^2: that of the station's frame, turned.
Eigen::Matrix3d readingCovariance(const metrology::TrackerNoise& noise, const Eigen::Isometry3d& r0_from_points,
                                  const Eigen::Vector3d& point_in_r0);

}  // namespace stiffscope::frames
