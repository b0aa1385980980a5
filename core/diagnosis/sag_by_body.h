#pragma once

#include "core/diagnosis/effect_model.h"

namespace stiffscope {

constexpr Eigen::Index kBodies = 6;

/// How the own weight of each body moves the reflectors of an unloaded state by turning the joints' springs,
/// m: one row a coordinate of a reflector, one column a body, for the weight as the URDF and the tool state
/// it.
Eigen::MatrixXd sagByBody(const WorkingPoint& at, const ArmState& state);

}  // namespace stiffscope
