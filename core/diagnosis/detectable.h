#pragma once

#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/gap_fit.h"

namespace stiffscope {

/// The rms per coordinate that lowers chi2 of the loading by `drop`, m.
double sizeOfDrop(const GapFit& fit, double drop);

/// Per effect the smallest size that would have been named, m: what the median of its parts must be before
/// the projection for what is left of it to pass the limits of significance and of size. The geometry's is a
/// limit of its own.
std::vector<DetectableSize> detectableSizes(const GapInput& input, const GapFit& fit,
                                            const std::vector<bool>& allowed);

}  // namespace stiffscope
