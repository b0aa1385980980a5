#pragma once

#include "core/diagnosis/gap_fit.h"

namespace stiffscope {

/// What the set leaves of the deflection at the largest load beyond noise, rms per coordinate, m, where that
/// is significant (four standard deviations of chi2, the noise's own doubt in it) and matters: more than the
/// smallest effect looked for, and more than a tenth of what the set removed, because models of large effects
/// are not exact to more. Else 0.
double modelError(const GapFit& fit, const FitRules& rules);

}  // namespace stiffscope
