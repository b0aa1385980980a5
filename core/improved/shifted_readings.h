#pragma once

#include "core/improved/effect_offsets.h"

namespace stiffscope {

struct ShiftOptions {
  PostureOffsets::Which which;
  Vector6d frame = Vector6d::Zero();  ///< of the loading: its motion (as frameError has it) is undone first
  bool sweeps = true;                 ///< false: the sweeps stay as they are
};

/// Takes what the effects add (PostureOffsets) off every reading of loading, displacements and, where they took part in the fit, sweeps.
void shiftReadings(const EffectFit& effects, const Eigen::VectorXd& parameters, const ShiftOptions& options,
                   Campaign& campaign);

}  // namespace stiffscope
