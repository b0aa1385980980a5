#pragma once

#include <vector>

#include "core/effects/effect_model.h"
#include "core/robot/robot.h"

namespace stiffscope::effects {

/// The unloaded arm at joint angles q (as reported, rad), its carriage at `carriage` (ArmState): sag of the joints'
/// springs, and what the effects in the model do under the own weight alone, each computed where the others have left
/// the arm.
ArmState gravityEquilibrium(const frames::LoadingGeometry& geometry, const LinearizationPoint& at, const JointVector& q,
                            double carriage = campaign::kNotGiven);

/// Where the last body of an arm of almost this geometry comes to, by one round of the above from where `near` rests:
/// what its torques' change does to these torques again, a hundredth of that change, is left out. For derivatives by
/// the geometry, of the same point twice.
Eigen::Isometry3d lastBodyNear(const frames::LoadingGeometry& geometry, const LinearizationPoint& at,
                               const ArmState& near);

/// Joint angles by which the effects in the model turn the arm where it rests, rad.
JointVector presentTurn(const LinearizationPoint& at, const ArmState& rest);

/// How the own weight of each body moves the reflectors of an unloaded state by turning the joints' springs,
/// m: one row a coordinate of a reflector, one column a body beyond a joint, for the weight as the URDF and the tool
/// state it.
Eigen::MatrixXd gravityDeflectionByBody(const LinearizationPoint& at, const ArmState& state);

}  // namespace stiffscope::effects
