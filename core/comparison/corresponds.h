#pragma once

#include "core/comparison/matched_postures.h"

namespace stiffscope::comparison {

/// Whether joint angles (rad) and force vectors (R0, N) of two days differ by no more than the limits.
bool corresponds(const Vector6d& q_before, const Eigen::Vector3d& force_before, const Vector6d& q_after,
                 const Eigen::Vector3d& force_after, const MatchLimits& limits = {});

}  // namespace stiffscope::comparison
