#pragma once

#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/arm_geometry.h"

namespace stiffscope::frames {

/// One reflector in the unloaded state of one posture: the mean of its readings, in the frame of the loading
/// table.
struct UnloadedPosition {
  int pose = 0;
  int target = 0;
  Vector6d q = Vector6d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  int readings = 0;
};

/// Of step 0, in the order of poses, then targets. Empty without `loading` or `states`.
std::vector<UnloadedPosition> unloadedPositions(const campaign::Campaign& campaign);

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

}  // namespace stiffscope::frames
