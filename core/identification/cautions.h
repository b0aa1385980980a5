#pragma once

#include <string>
#include <vector>

#include "core/identification/identification.h"

namespace stiffscope {

/// Unloaded positions that miss by more, rms, m: an arm's own sag is taken off before, and what that leaves of a heavy one
/// is a millimetre or two. Units, angles or the tracker's place are wrong.
inline constexpr double kMissedGeometry = 0.020;

/// What a reader must know before believing the numbers, a sentence each: a residual far above the tracker's noise,
/// negative stiffnesses, forces too small or too large for what they move, a geometry that the readings miss by centimetres, sweeps that do not fit, too few postures.
/// Limits: three times the noise for residuals (beyond what a misdeclared tracker explains), kMissedGeometry for a geometry, half the deflection for noise.
std::vector<std::string> cautionsOf(const Campaign& campaign, const Identification& result);

/// Whether some available method has a joint with a positive stiffness.
bool anyUsable(const Identification& result, const std::vector<Method>& methods);

}  // namespace stiffscope
