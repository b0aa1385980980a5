#pragma once

#include <Eigen/Core>

namespace stiffscope {

/// A load that keeps its force and moment in R0 and acts at a point fixed to the tool.
struct ToolLoad {
  Eigen::Vector3d point_at_zero = Eigen::Vector3d::Zero();  ///< where the point stands in R0 at all joints zero, m
  Eigen::Vector3d force = Eigen::Vector3d::Zero();          ///< R0 axes, N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();         ///< R0 axes, about the point, Nm
};

}  // namespace stiffscope
