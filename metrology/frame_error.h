#pragma once

#include <Eigen/Geometry>

namespace stiffscope {

/// How a frame that was measured differs from the true one: a small rotation vector (rad) and the shift of its origin
/// (m), both in the frame's own axes: in_from_measured = in_from_true * (1 + [rotation x], origin).
using FrameError = Eigen::Matrix<double, 6, 1>;
using FrameCovariance = Eigen::Matrix<double, 6, 6>;

FrameError frameError(const Eigen::Isometry3d& in_from_true, const Eigen::Isometry3d& in_from_measured);

/// What a frame's error does to the coordinates of a point x in it: -rotation x x - origin. 3x6.
Eigen::Matrix<double, 3, 6> pointByFrameError(const Eigen::Vector3d& x);

/// The same of a free vector d, a displacement or a direction: -rotation x d. The shift of the origin does nothing.
Eigen::Matrix<double, 3, 6> vectorByFrameError(const Eigen::Vector3d& d);

}  // namespace stiffscope
