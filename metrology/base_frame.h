#pragma once

#include <Eigen/Geometry>

#include "metrology/line.h"

namespace stiffscope {

/// R0 from two measured axes: z0 along axis 1; origin at the foot, on axis 1, of the common perpendicular to axis 2;
/// y0 along the part of axis 2 at right angles to z0; x0 = y0 x z0 (paper, II.D). The caller directs both axes.
/// Returns frame_from_r0 for the frame in which the axes are given. Assumes axes that are not parallel.
Eigen::Isometry3d baseFrame(const Line& axis_1, const Line& axis_2);

}  // namespace stiffscope
