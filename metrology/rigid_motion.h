#pragma once

#include <Eigen/Geometry>

#include "metrology/lines.h"

namespace stiffscope::metrology {

/// [v x]: the matrix by which v x w is a product with w.
Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v);

/// The rotation R that maximises trace(R^T M), which is nearest to a map M, and M's singular values, descending. Proper
/// where M turns right hands to left, too: the least singular direction takes the sign (S. Umeyama, IEEE Transactions
/// on Pattern Analysis and Machine Intelligence 13, 1991, 376). Determined where the second singular value is not zero.
struct NearestRotation {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d singular_values;
};
NearestRotation nearestRotation(const Eigen::Matrix3d& map);

/// R0 from two measured axes: z0 along axis 1; origin at the foot, on axis 1, of the common perpendicular to axis 2;
/// y0 along the part of axis 2 at right angles to z0; x0 = y0 x z0 (paper, II.D). The caller directs both axes.
/// Returns frame_from_r0 for the frame in which the axes are given. Assumes axes that are not parallel.
Eigen::Isometry3d baseFrame(const Line& axis_1, const Line& axis_2);

/// How a frame that was measured differs from the true one: a small rotation vector (rad) and the shift of its origin
/// (m), both in the frame's own axes: in_from_measured = in_from_true * (1 + [rotation x], origin).
using FrameError = Eigen::Matrix<double, 6, 1>;
using FrameCovariance = Eigen::Matrix<double, 6, 6>;

FrameError frameError(const Eigen::Isometry3d& in_from_true, const Eigen::Isometry3d& in_from_measured);

/// What a frame's error does to the coordinates of a point x in it: -rotation x x - origin. 3x6.
Eigen::Matrix<double, 3, 6> pointByFrameError(const Eigen::Vector3d& x);

/// What it does to a free vector d, a displacement or a direction: -rotation x d. The shift of the origin does nothing.
Eigen::Matrix<double, 3, 6> vectorByFrameError(const Eigen::Vector3d& d);

/// The rigid motion of a rotation vector and a displacement at `centre`.
Eigen::Isometry3d motionAbout(const Eigen::Vector3d& centre, const Eigen::Matrix<double, 6, 1>& motion);

}  // namespace stiffscope::metrology
