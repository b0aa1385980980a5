#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/sag_model.h"

namespace stiffscope {

/// The sweeps' readings referred to the rigid arm: each less the sag of its reflector at its joint angles. Rows as in
/// the campaign's tables, in the frame of the readings, m.
struct RigidPoints {
  std::vector<Eigen::Vector3d> circle_sweeps;
  std::vector<Eigen::Vector3d> wrist_sweep;
  double largest_sag = 0.0;  ///< taken off a reading, m
};

RigidPoints rigidPoints(const Campaign& campaign, const SagModel& sag);

}  // namespace stiffscope
