#pragma once

#include <vector>

#include "core/robot/robot.h"

namespace stiffscope {

/// Four points that show a rigid motion: the first, and one metre from it along each axis, m.
std::vector<Eigen::Vector3d> probesAt(const Eigen::Vector3d& first);

/// The small motion that displaced these four by `moved` (stacked, m): rotation vector (rad), then displacement of the
/// first. Of a field u + w x r the sum of e_k x (w x e_k) is 2 w.
Vector6d probedMotion(const Eigen::VectorXd& moved);

}  // namespace stiffscope
