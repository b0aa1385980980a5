#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// How far the reflectors have left their nests, through one posture's loads in their order.
class ReflectorSeats {
 public:
  explicit ReflectorSeats(const std::vector<TrueTarget>& targets);

  /// Shifts of the targets (flange axes, m) once this force of the load on the tool (flange axes, N) is on.
  const std::vector<Eigen::Vector3d>& under(const Eigen::Vector3d& force_in_flange);

 private:
  const std::vector<TrueTarget>& targets_;
  std::vector<bool> slipped_;
  std::vector<Eigen::Vector3d> shifts_;
};

}  // namespace stiffscope::simulation
