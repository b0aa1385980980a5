#pragma once

#include <cstdint>
#include <vector>

#include "core/identification/subset_sums.h"

namespace stiffscope {

/// `count` random subsets of `size` postures, by the Mersenne twister of that seed, some in each of the sums, in
/// the order in which they are drawn; solved and judged on all cores, with the same results whatever their number.
std::vector<SubsetSums> sampleSubsets(const SubsetMethod& method, std::size_t size, std::size_t count, std::uint64_t seed);

}  // namespace stiffscope
