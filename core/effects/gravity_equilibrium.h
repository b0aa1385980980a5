#pragma once

#include <vector>

#include "core/effects/effect_model.h"
#include "core/robot/robot.h"

namespace stiffscope::effects {

/// The unloaded arm at joint angles q (as reported, rad): sag of the joints' springs, and what the effects in
/// the model do under the own weight alone, each computed where the others have left the arm.
ArmState gravityEquilibrium(const frames::LoadingGeometry& geometry, const LinearizationPoint& at, const Vector6d& q);

/// Joint angles by which the effects in the model turn the arm where it rests, rad.
Vector6d presentTurn(const LinearizationPoint& at, const ArmState& rest);

constexpr Eigen::Index kBodies = 6;

/// How the own weight of each body moves the reflectors of an unloaded state by turning the joints' springs,
/// m: one row a coordinate of a reflector, one column a body, for the weight as the URDF and the tool state
/// it.
Eigen::MatrixXd gravityDeflectionByBody(const LinearizationPoint& at, const ArmState& state);

}  // namespace stiffscope::effects
