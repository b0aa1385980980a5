#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace stiffscope::numerics {

/// Has the sums of large matrix products taken in one order on every processor: Eigen cuts them into pieces that suit
/// the processor's caches, and rounding depends on the pieces. To be called once, before anything is computed. What is
/// left are the last digits of exp, sin and their kin, which processors that multiply and add at once have otherwise.
void sumAlikeEverywhere();

/// Calls work(i) once for each i in 0..count-1, shared among as many threads as this process has cores, the calling one
/// among them; returns when all have ended. Indices are begun in ascending order. Calls run at the same time: they may
/// read what they have in common, and each writes only what is its own, so that nothing depends on the number of
/// threads. Where calls throw, the exception of the lowest index is thrown here and none further is begun. A call that
/// itself shares work does so with the cores that have run out of work meanwhile, or alone. Not `worth_it`: this thread
/// does all, as where threads take longer than the work.
void onAllCores(std::size_t count, const std::function<void(std::size_t)>& work, bool worth_it = true);

/// The same on so many threads, the calling one among them, whatever the number of cores.
void onThreads(std::size_t threads, std::size_t count, const std::function<void(std::size_t)>& work);

/// Pieces of work of about a microsecond that are worth starting threads, which takes some ten of them.
inline constexpr std::size_t kWorthThreads = 1024;

/// onAllCores of work of about a microsecond an index.
template <class Work>
void smallWorkOnAllCores(std::size_t count, const Work& work) {
  constexpr std::size_t kBlock = 256;
  onAllCores((count + kBlock - 1) / kBlock,
             [&](std::size_t block) {
               const std::size_t end = std::min(count, (block + 1) * kBlock);
               for (std::size_t i = block * kBlock; i < end; ++i) work(i);
             },
             count >= kWorthThreads);
}

/// The sum of what add(i, sum) adds for each i in 0..count-1 to a Sum{}: block by block, on all cores where there are
/// many blocks, and their sums one to the other (+=) in their order, so that rounding depends on the count alone.
/// `microseconds`: of one i, about; the longer, the fewer of them make a block.
template <class Sum, class Add>
Sum sumInBlocks(std::size_t count, const Add& add, std::size_t microseconds = 1) {
  const std::size_t size = std::max<std::size_t>(1, 256 / microseconds);
  std::vector<Sum> blocks(std::max<std::size_t>(1, (count + size - 1) / size));
  onAllCores(
      blocks.size(),
      [&](std::size_t block) {
        Sum sum{};
        for (std::size_t i = block * size; i < std::min(count, (block + 1) * size); ++i) add(i, sum);
        blocks[block] = std::move(sum);
      },
      count * microseconds >= kWorthThreads);
  for (std::size_t block = 1; block < blocks.size(); ++block) blocks.front() += blocks[block];
  return std::move(blocks.front());
}

}  // namespace stiffscope::numerics
