#pragma once

#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope {

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
std::vector<UnloadedPosition> unloadedPositions(const Campaign& campaign);

}  // namespace stiffscope
