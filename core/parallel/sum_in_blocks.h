#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/parallel/on_all_cores.h"

namespace stiffscope {

/// The sum of what add(i, sum) adds for each i in 0..count-1 to a Sum{}: block by block, on all cores where there are many
/// blocks, and their sums one to the other (+=) in their order, so that rounding depends on the count alone.
template <class Sum, class Add>
Sum sumInBlocks(std::size_t count, const Add& add) {
  constexpr std::size_t kBlock = 256;
  std::vector<Sum> blocks(std::max<std::size_t>(1, (count + kBlock - 1) / kBlock));
  onAllCores(blocks.size(), [&](std::size_t block) {
    Sum sum{};
    for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) add(i, sum);
    blocks[block] = std::move(sum);
  }, count >= kWorthThreads);
  for (std::size_t block = 1; block < blocks.size(); ++block) blocks.front() += blocks[block];
  return std::move(blocks.front());
}

}  // namespace stiffscope
