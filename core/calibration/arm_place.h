#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/calibration/unloaded_day.h"

namespace stiffscope::calibration {

/// Where the readings' frame and the reflectors stand by the nominal arm alone: a start, good to what the nominal arm
/// is.
struct ArmPlace {
  Eigen::Isometry3d base_from_points = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3d> targets_at_zero;  ///< in base_link with all joints at zero, one a target
};

/// Finds them from the postures, from one reflector on: the readings are registered on the modelled points, the
/// reflectors are the mean of where the readings put them on the flange, in turns. Each turn leaves out the fifth of
/// the readings that fits worst, so that a few readings which are wrong by any amount do not matter. `weights`: one a
/// reading in the order of the day, 0: not used. Several starts for reflectors far from the flange; the one with the
/// smallest median distance is taken. Empty with fewer than four readings, or readings on one line.
std::optional<ArmPlace> placeArm(const UnloadedDay& day, const std::vector<double>& weights);

}  // namespace stiffscope::calibration
