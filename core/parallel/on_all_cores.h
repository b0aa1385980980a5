#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace stiffscope {

/// Calls work(i) once for each i in 0..count-1, shared among as many threads as this process has cores, the calling one
/// among them; returns when all have ended. Indices are begun in ascending order. Calls run at the same time: they may
/// read what they have in common, and each writes only what is its own, so that nothing depends on the number of threads.
/// Where calls throw, the exception of the lowest index is thrown here and none further is begun. A call that itself shares
/// work does so alone: the cores are busy already. Not `worth_it`: this thread does all, as where threads take longer than
/// the work.
void onAllCores(std::size_t count, const std::function<void(std::size_t)>& work, bool worth_it = true);

/// Pieces of work of about a microsecond that are worth starting threads, which takes some ten of them.
inline constexpr std::size_t kWorthThreads = 1024;

/// onAllCores of work of about a microsecond an index.
template <class Work>
void smallWorkOnAllCores(std::size_t count, const Work& work) {
  constexpr std::size_t kBlock = 256;
  onAllCores((count + kBlock - 1) / kBlock, [&](std::size_t block) {
    const std::size_t end = std::min(count, (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i) work(i);
  }, count >= kWorthThreads);
}

}  // namespace stiffscope
