#pragma once

#include "core/diagnosis/gap_data.h"

namespace stiffscope {

/// Adds the equations of every posture of the loading to `data`: y = A c + geometry + own weights + effects +
/// noise for the unloaded absolute positions (where they take part) and the displacements, each posture
/// whitened by its own covariance. Fills `loading_rows` and `state_noise`.
void addPostureEquations(const GapInput& input, const GapState& state, const ContainedEffects& effects_now,
                         GapData& data);

}  // namespace stiffscope
