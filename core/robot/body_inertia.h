#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "core/robot/robot.h"

namespace stiffscope::robot {

/// Inertia of a point mass about a point that `arm` (m) leads to or from (Steiner's term), kg m^2.
inline Eigen::Matrix3d pointMassInertia(double mass_kg, const Eigen::Vector3d& arm) {
  return mass_kg * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
}

/// Rotational inertia of each body of the chain, with everything fixed to it, about the centre of mass that
/// Robot::bodies has, in base_link axes with all joints at zero (kg m^2): of its links, each with its mass carried to
/// that centre (Steiner). A link without `inertia` counts as a point mass; zero for a body without mass. Reads the URDF
/// as parseUrdf does, and throws as that does.
PerBody<Eigen::Matrix3d> bodyInertias(std::string_view bytes, const std::string& file, const std::string& base_link,
                                      const std::string& flange_link);

}  // namespace stiffscope::robot
