#include "core/numerics/parallel.h"

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace stiffscope::numerics {

namespace {

thread_local bool shares_already = false;
std::atomic<std::size_t> at_work{0};  // threads that take part in something

/// Cores that this process may use: those that the system gives it, and no more than STIFFSCOPE_THREADS of the
/// environment says, where that is a number. For processes that run beside each other.
std::size_t cores() {
  static const std::size_t known = [] {
    const std::size_t given = std::max(1U, std::thread::hardware_concurrency());
    const char* asked = std::getenv("STIFFSCOPE_THREADS");
    const long most = asked == nullptr ? 0 : std::strtol(asked, nullptr, 10);
    return most > 0 ? std::min(given, static_cast<std::size_t>(most)) : given;
  }();
  return known;
}

std::size_t idleCores() {
  const std::size_t all = cores(), busy = at_work;
  return all > busy ? all - busy : 0;
}

class Sharing {
 public:
  Sharing(std::size_t count, const std::function<void(std::size_t)>& work) : count_(count), work_(work) {}

  /// What each thread does: takes the next index until there is none.
  void takePart() {
    const bool within = std::exchange(shares_already, true);
    if (!within) ++at_work;
    for (std::size_t i = next_++; i < count_; i = next_++) {
      try {
        work_(i);
      } catch (...) {
        keep(i, std::current_exception());
      }
    }
    if (!within) --at_work;
    shares_already = within;
  }

  void throwWhatWasThrown() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  void keep(std::size_t i, std::exception_ptr thrown) {
    const std::lock_guard lock(keeping_);
    next_ = count_;
    if (thrown_ && lowest_ < i) return;
    thrown_ = std::move(thrown), lowest_ = i;
  }

  const std::size_t count_;
  const std::function<void(std::size_t)>& work_;
  std::atomic<std::size_t> next_{0};
  std::mutex keeping_;
  std::exception_ptr thrown_;
  std::size_t lowest_ = 0;
};

}  // namespace

void sumAlikeEverywhere() {
  // Of a common core, bytes.
  constexpr std::ptrdiff_t kFirst = 32 << 10, kSecond = 512 << 10, kThird = 4 << 20;
  Eigen::setCpuCacheSizes(kFirst, kSecond, kThird);
}

void onAllCores(std::size_t count, const std::function<void(std::size_t)>& work, bool worth_it) {
  if (!worth_it) return onThreads(1, count, work);
  onThreads(shares_already ? 1 + idleCores() : cores(), count, work);
}

void onThreads(std::size_t threads, std::size_t count, const std::function<void(std::size_t)>& work) {
  threads = std::min(count, threads);
  if (threads < 2) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  Sharing sharing(count, work);
  {
    std::vector<std::jthread> others;
    try {
      while (others.size() + 1 < threads) others.emplace_back([&] { sharing.takePart(); });
    } catch (const std::system_error&) {
      // No more threads are to be had: those that are do it.
    }
    sharing.takePart();
  }
  sharing.throwWhatWasThrown();
}

}  // namespace stiffscope::numerics
