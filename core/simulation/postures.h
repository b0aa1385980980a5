#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// A posture of the loading and the direction a fixed-direction cable pulls there (unit, base_link), if
/// listed.
struct Posture {
  Vector6d q = Vector6d::Zero();  ///< rad
  std::optional<Eigen::Vector3d> pull_direction;
};

/// The listed postures, then the drawn ones (stream "postures" of the seed). Nested: asking for more postures
/// leaves the first ones as they are. With `candidates` above one, each is the one of so many random postures
/// that is farthest from those before it, listed ones included, in joint angles over the width of the box
/// (Mitchell's best candidate). Throws InputError when the rules leave nothing to find.
std::vector<Posture> loadingPostures(const SimulationSpec& spec);

/// Place of the flange of the nominal rigid arm.
Eigen::Isometry3d nominalFlange(const Robot& robot, const Vector6d& q);

/// Horizontal distance (m) from the vertical through the hook to the nearest part of the arm that is lower
/// than the hook: the arm taken as straight lines from the base's origin over the points of axes 1-6 to the
/// flange. Infinite if none is lower.
double hangClearance(const Robot& robot, const Vector6d& q, const Eigen::Vector3d& hook_in_flange);

}  // namespace stiffscope::simulation
