#pragma once

#include <optional>

#include "core/identification/loading_geometry.h"
#include "core/identification/unloaded_positions.h"

namespace stiffscope {

/// Where the base stands in the loading's readings, and the reflectors on the flange, found from postures
/// alone where no sweep places R0: a start for the calibration.
struct BaseFromPostures {
  Eigen::Isometry3d points_from_base = Eigen::Isometry3d::Identity();
  std::vector<std::optional<Eigen::Vector3d>> targets_at_zero;
};

/// The rotations of the reflector triangle from the first posture to each other one are those of the flange
/// seen from another frame: their rotation vectors, brought onto each other, give the base's direction; the
/// rest is linear. Empty with fewer than three reflectors common to three postures, or with rotations about
/// one axis only.
std::optional<BaseFromPostures> baseFromPostures(const LoadingGeometry& geometry,
                                                 const std::vector<UnloadedPosition>& positions,
                                                 std::size_t target_count);

}  // namespace stiffscope
