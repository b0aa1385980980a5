#pragma once

#include <Eigen/Geometry>

#include "core/robot/robot.h"

namespace stiffscope {

/// Force and moment in base axes, the moment taken about `point` (base frame). N, Nm, m.
struct Wrench {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();

  /// The same load, its moment taken about another point: M' = M + (point - other) x F.
  Wrench about(const Eigen::Vector3d& other) const { return {other, force, moment + (point - other).cross(force)}; }

  /// (30): force then moment.
  Vector6d vector() const { return (Vector6d() << force, moment).finished(); }
};

}  // namespace stiffscope
