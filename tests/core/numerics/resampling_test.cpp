#include "core/numerics/resampling.h"

#include <gtest/gtest.h>

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
