#include "core/numerics/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace stiffscope {
namespace parallel_test {

TEST(OnAllCores, EachIndexOnceWithinAnotherToo) {
  constexpr std::size_t kOuter = 6, kInner = 500;
  std::vector<std::vector<int>> done(kOuter, std::vector<int>(kInner, 0));
  numerics::onAllCores(kOuter, [&](std::size_t i) {
    // The first ends at once: its thread's core is then idle, and helps the others.
    if (i > 0) numerics::onAllCores(kInner, [&](std::size_t k) { ++done[i][k]; });
  });
  for (std::size_t i = 1; i < kOuter; ++i) EXPECT_EQ(done[i], std::vector<int>(kInner, 1));
  EXPECT_EQ(done[0], std::vector<int>(kInner, 0));
}

TEST(OnAllCores, ThrowsWhatTheLowestIndexWithinThrew) {
  for (int turn = 0; turn < 20; ++turn) {
    try {
      numerics::onAllCores(2, [&](std::size_t i) {
        numerics::onAllCores(10, [&](std::size_t k) {
          if (k >= 3) throw std::runtime_error(std::to_string(i) + std::to_string(k));
        });
      });
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "03");
    }
  }
}

TEST(OnAllCores, ACallWithinTakesTheCoreThatIsIdle) {
  if (std::thread::hardware_concurrency() != 2) GTEST_SKIP() << "counts on two cores";
  std::atomic<bool> first_ended = false;
  std::atomic<int> at_once = 0, most = 0;
  numerics::onAllCores(2, [&](std::size_t i) {
    if (i == 0) {
      first_ended = true;
      return;
    }
    using namespace std::chrono_literals;
    while (!first_ended) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(50ms);  // until its thread has found that nothing is left
    numerics::onAllCores(2, [&](std::size_t) {
      most = std::max<int>(most, ++at_once);
      std::this_thread::sleep_for(100ms);
      --at_once;
    });
  });
  EXPECT_EQ(most, 2);
}

TEST(SumInBlocks, SumsAllWhateverTheBlocks) {
  constexpr std::size_t kCount = 10'007;
  const auto sum = [](std::size_t microseconds) {
    return numerics::sumInBlocks<long>(
        kCount, [](std::size_t i, long& own) { own += static_cast<long>(i); }, microseconds);
  };
  for (const std::size_t microseconds : {1u, 40u, 1000u})
    EXPECT_EQ(sum(microseconds), static_cast<long>(kCount * (kCount - 1) / 2));
}

}  // namespace parallel_test
}  // namespace stiffscope
