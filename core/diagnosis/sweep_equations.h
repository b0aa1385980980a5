#pragma once

#include "core/diagnosis/gap_data.h"

namespace stiffscope {

/// Adds the equations of circle and wrist sweeps to `data.sweeps`: absolute positions of unloaded postures,
/// y = sag + geometry + own weights + effects + noise, whitened reading by reading.
void addSweepEquations(const GapInput& input, const GapState& state, const ContainedEffects& effects_now,
                       GapData& data);

}  // namespace stiffscope
