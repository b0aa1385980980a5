#pragma once

#include <functional>

#include "core/improved/effect_offsets.h"

namespace stiffscope {

/// Offsets of one reflector in the states of a posture, given the place where it stands unloaded; R0, m.
using OffsetsOf =
    std::function<std::vector<Eigen::Vector3d>(const PostureOffsets& posture, int target, const Eigen::Vector3d& place)>;

struct ShiftOptions {
  PostureOffsets::Which which;
  OffsetsOf offsets;
  Vector6d frame = Vector6d::Zero();  ///< of the loading: its motion (as frameError has it) is undone first
  bool sweeps = true;                 ///< false: the sweeps stay as they are
};

/// Takes offsets off every reading of loading, displacements and, where they took part in the fit, sweeps.
void shiftReadings(const EffectFit& effects, const Eigen::VectorXd& parameters, const ShiftOptions& options,
                   Campaign& campaign);

}  // namespace stiffscope
