#pragma once

#include <vector>

#include "core/effects/effect_model.h"
#include "core/robot/robot.h"

namespace stiffscope::effects {

/// Four points that show a rigid motion: the first, and one metre from it along each axis, m.
std::vector<Eigen::Vector3d> probesAt(const Eigen::Vector3d& first);

/// The small motion that displaced these four by `moved` (stacked, m): rotation vector (rad), then displacement of the
/// first. Of a field u + w x r the sum of e_k x (w x e_k) is 2 w.
Vector6d probedMotion(const Eigen::VectorXd& moved);

/// The unloaded arm at joint angles q (as reported, rad): sag of the joints' springs, and what the effects in
/// the model do under the own weight alone, each computed where the others have left the arm.
ArmState restState(const frames::LoadingGeometry& geometry, const WorkingPoint& at, const Vector6d& q);

/// Joint angles by which the effects in the model turn the arm where it rests, rad.
Vector6d presentTurn(const WorkingPoint& at, const ArmState& rest);

constexpr Eigen::Index kBodies = 6;

/// How the own weight of each body moves the reflectors of an unloaded state by turning the joints' springs,
/// m: one row a coordinate of a reflector, one column a body, for the weight as the URDF and the tool state
/// it.
Eigen::MatrixXd sagByBody(const WorkingPoint& at, const ArmState& state);

}  // namespace stiffscope::effects
