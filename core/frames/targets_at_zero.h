#pragma once

#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/arm_in_r0.h"
#include "core/frames/rigid_points.h"

namespace stiffscope {

/// Where each reflector would stand in R0 with all joints at zero: the mean of its sweep readings, referred to the
/// rigid arm and turned back by their joint angles. Where a target's place on the flange is declared and no
/// reading shows it, that place. Empty for a target that neither gives.
std::vector<std::optional<Eigen::Vector3d>> targetsAtZero(const Campaign& campaign, const ArmInR0& arm,
                                                          const RigidPoints& points);

}  // namespace stiffscope
