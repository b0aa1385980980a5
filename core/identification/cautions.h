#pragma once

#include <string>
#include <vector>

#include "core/identification/identify.h"

namespace stiffscope {

/// What a reader must know before believing the numbers, a sentence each: a residual far above the tracker's noise,
/// negative stiffnesses, a geometry that the readings miss by centimetres, sweeps that do not fit, too few postures.
/// Limits: three times the noise for residuals (beyond what a misdeclared tracker explains), 20 mm for a geometry (ten times
/// the sag of a heavy arm), half the deflection for noise.
std::vector<std::string> cautionsOf(const Campaign& campaign, const Identification& result);

/// Whether some available method has a joint with a positive stiffness.
bool anyUsable(const Identification& result, const std::vector<Method>& methods);

}  // namespace stiffscope
