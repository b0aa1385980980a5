#pragma once

#include <cstdint>

#include "core/diagnosis/gap_fit.h"

namespace stiffscope {

/// The fall of the score that the best of all effects reaches by chance, exceeded in a share `false_alarm` of clean
/// campaigns: the whole search is run on draws of pure noise. In whitened equations the right sides s of noise have
/// covariance S (see Projection), so a draw is S^1/2 times normal numbers.
double chanceLimit(const GapInput& input, const GapFit& fit, const std::vector<bool>& allowed, int draws,
                   double false_alarm, std::uint64_t seed);

}  // namespace stiffscope
