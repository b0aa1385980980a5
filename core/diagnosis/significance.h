#pragma once

#include <cstdint>
#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/fit.h"

namespace stiffscope::diagnosis {

/// The fall of the score that the best of all effects reaches by chance, exceeded in a share `false_alarm` of
/// clean campaigns: the whole search is run on draws of pure noise. In whitened equations the right sides s
/// of noise have covariance S (see Projection), so a draw is S^1/2 times normal numbers.
double chanceLimit(const SystemInput& input, const GapFit& fit, const std::vector<bool>& allowed, int draws,
                   double false_alarm, std::uint64_t seed);

/// The rms per coordinate that lowers chi2 of the loading by `drop`, m.
double sizeOfDrop(const GapFit& fit, double drop);

/// Per effect the smallest size that would have been named, m: what the median of its parts must be before
/// the projection for what is left of it to pass the limits of significance and of size, with all that the fit counts
/// as noise (the error of the model, the inflation of positions) in it. The geometry's is a limit of its own.
std::vector<DetectableSize> detectableSizes(const SystemInput& input, const GapFit& fit,
                                            const std::vector<bool>& allowed);

}  // namespace stiffscope::diagnosis
