#include "core/numerics/resampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace stiffscope {
namespace resampling_test {

using numerics::Weights;

TEST(Quantile, LinearBetweenNeighbours) {
  const std::vector<double> values{1.0, 2.0, 4.0, 8.0, 16.0};
  EXPECT_EQ(numerics::quantile(values, 0.0), 1.0);
  EXPECT_EQ(numerics::quantile(values, 0.5), 4.0);
  EXPECT_EQ(numerics::quantile(values, 0.875), 12.0);
  EXPECT_EQ(numerics::quantile(values, 1.0), 16.0);
  EXPECT_EQ(numerics::quantile({3.0}, 0.3), 3.0);
  for (const double share : {0.0, 0.3, 0.5, 0.6827, 0.875, 1.0}) {
    std::vector<double> others(values.rbegin(), values.rend());
    std::swap(others[0], others[2]);
    EXPECT_EQ(numerics::quantileOf(others, share), numerics::quantile(values, share)) << share;
    EXPECT_EQ(numerics::quantileOf({3.0}, share), 3.0);
  }
}

// Draws at even steps of probability of a distribution that leans to the right; the factor of ten postures by hand, of
// tables: sqrt(10 / 9) 2.2622 / 1.9600 = 1.2166.
TEST(BootstrapSpread, ReachesFromTheMiddleWidenedForFew) {
  std::vector<double> draws;
  constexpr int kDraws = 10000;
  for (int i = 0; i < kDraws; ++i) draws.push_back(-std::log(1.0 - (i + 0.5) / kDraws));
  std::reverse(draws.begin(), draws.end());
  const numerics::BootstrapSpread spread = numerics::bootstrapSpread(draws, 10.0);
  const double middle = std::log(2.0), low = -std::log(0.975), high = -std::log(0.025);
  EXPECT_NEAR(spread.middle, middle, 1e-3);
  EXPECT_NEAR(spread.below, 1.2166 * (middle - low), 1e-3);
  EXPECT_NEAR(spread.above, 1.2166 * (high - middle), 2e-2);
  EXPECT_EQ(numerics::bootstrapSpread({}, 10.0).above, 0.0);
}

// Against quantiles of distributions at even steps of probability: one that falls from zero on begins there, one that
// falls to both sides leaves out as much at either.
TEST(ShortestInterval, LeavesOutTheLongTail) {
  std::vector<double> falling, even;
  constexpr int kDraws = 10000;
  for (int i = 0; i < kDraws; ++i) {
    const double p = (i + 0.5) / kDraws;
    falling.push_back(-std::log(1.0 - p));
    even.push_back(std::log(p / (1.0 - p)));
  }
  const auto [from, to] = numerics::shortestInterval(falling, 0.95);
  EXPECT_NEAR(from, 0.0, 1e-3);
  EXPECT_NEAR(to, -std::log(0.05), 2e-3);
  const auto [low, high] = numerics::shortestInterval(even, 0.95);
  EXPECT_NEAR(low, std::log(0.025 / 0.975), 4e-3);
  EXPECT_NEAR(high, -std::log(0.025 / 0.975), 4e-3);
  EXPECT_EQ(numerics::shortestInterval({3.0}, 0.95), (std::pair{3.0, 3.0}));
}

TEST(Bootstrap, DrawsAsManyAsThereAreAndTheSameAgain) {
  std::mt19937_64 random(7), again(7);
  Weights counted(19, 0.0);
  numerics::drawWithReplacement(random, 19, [&](std::size_t index) { counted.at(index) += 1.0; });
  EXPECT_EQ(numerics::drawWeights(again, 19), counted);
  EXPECT_EQ(std::accumulate(counted.begin(), counted.end(), 0.0), 19.0);
}

TEST(LeaveOneOut, IsAllButOne) { EXPECT_EQ(numerics::leaveOneOut(4, 2), (Weights{1.0, 1.0, 0.0, 1.0})); }

TEST(Subsets, EveryOneOnceWhereTheyAreFew) {
  std::set<Weights> seen;
  numerics::forEachSubset(6, 3, 20, 1, [&](const Weights& used) {
    EXPECT_EQ(std::accumulate(used.begin(), used.end(), 0.0), 3.0);
    EXPECT_TRUE(seen.insert(used).second);
  });
  EXPECT_EQ(seen.size(), numerics::subsetCount(6, 3));
}

TEST(Subsets, ASampleWhereTheyAreMany) {
  int drawn = 0;
  Weights taken(30, 0.0);
  numerics::forEachSubset(30, 10, 600, 1, [&](const Weights& used) {
    EXPECT_EQ(std::accumulate(used.begin(), used.end(), 0.0), 10.0);
    for (std::size_t i = 0; i < used.size(); ++i) taken[i] += used[i];
    ++drawn;
  });
  EXPECT_EQ(drawn, 600);
  // Each is in a third of 600 subsets, sd sqrt(600 * 2/9) = 11.5: five of them.
  for (const double times : taken) EXPECT_NEAR(times, 200.0, 58.0);
}

}  // namespace resampling_test
}  // namespace stiffscope
