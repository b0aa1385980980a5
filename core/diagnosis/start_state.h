#pragma once

#include "core/diagnosis/gap_data.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope {

/// What the fit starts from: geometry and stiffnesses as identification has them; what the campaign's states
/// and load cases (one step, in that geometry) say of forces, torques and times.
GapState startState(const Campaign& campaign, const LoadingGeometry& geometry,
                    const std::vector<LoadCase>& cases);

/// Where the load itself pulls, from the declared point of the wrench, flange axes, m: the point d through
/// which all wrenches pass as nearly as can be, M = (R d) x F, by least squares over the cases. Directions
/// the readings do not settle stay at the declared point: each coordinate of d is expected within 0.3 m
/// beside readings of `moment_sigma` (Nm).
Eigen::Vector3d loadOffset(const Robot& arm, const std::vector<LoadCase>& cases, double moment_sigma);

}  // namespace stiffscope
