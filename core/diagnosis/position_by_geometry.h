#pragma once

#include "core/diagnosis/arm_geometry.h"
#include "core/diagnosis/effect_model.h"

namespace stiffscope {

/// Derivatives of an unloaded state's absolute positions, modelled less measured, by the geometry's steps:
/// one row a coordinate of each reflector, one column a step of GeometrySteps.
///
/// In a product of exponentials, moving axis j by a small motion xi moves what is beyond it by
/// M_{j-1} xi M_{j-1}^-1 - M_j xi M_j^-1, M_b the motion of body b; the base's steps move the readings, the
/// reflectors' steps turn with body 6. The own weight's torques tau change with axes and bodies, and with
/// them the sag and what effects in the model turn the joints by: d theta = (C + T) (d tau + K_c d theta) + U
/// d theta, T and U the slopes of these turns by torque and angle. What effects move bodies by is taken not
/// to change.
Eigen::MatrixXd positionByGeometry(const LoadingGeometry& geometry, const WorkingPoint& at,
                                   const ArmState& state, const Eigen::Vector3d& centre);

}  // namespace stiffscope
