#pragma once

#include <optional>

#include "core/identification/loading_geometry.h"
#include "core/statics/wrench.h"

namespace stiffscope {

/// A load that keeps its force and moment in R0 and acts at a point fixed to the flange.
struct FlangeLoad {
  Eigen::Vector3d point_in_flange = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< R0 axes, N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< R0 axes, about the point, Nm
};

/// Joint angles of the arm on its springs: q + c (own weight's torque + load's torque), both on the moved
/// arm; fixed-point iteration to 1e-12 rad. `compliance` acts for both the weight and the load. Empty where
/// it does not settle (a load beyond buckling).
std::optional<Vector6d> loadedAngles(const LoadingGeometry& geometry, const Vector6d& compliance,
                                     const Vector6d& q, const FlangeLoad& load);

}  // namespace stiffscope
