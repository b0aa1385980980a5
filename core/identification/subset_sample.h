#pragma once

#include <cstdint>

#include "core/identification/subset_sums.h"

namespace stiffscope {

/// `count` random subsets of `size` postures, by the Mersenne twister of that seed; solved and judged on all cores, and
/// drawn and summed in one order, whatever their number.
SubsetSums sampleSubsets(const SubsetMethod& method, std::size_t size, std::size_t count, std::uint64_t seed);

}  // namespace stiffscope
