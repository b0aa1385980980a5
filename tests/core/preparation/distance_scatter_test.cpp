#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/preparation/prepare.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/clean_day.h"

// Days whose states were read once: the noise shows in the distances between reflectors alone.

namespace stiffscope {
namespace distance_scatter_test {

campaign::Campaign dayReadOnce(std::uint64_t seed, double noise_factor) {
  campaign::Campaign day = simulation::simulate(cleanDay(seed, noise_factor));
  std::erase_if(day.loading->rows, [first = day.loading->rows.front().repeat](const campaign::LoadingReading& row) {
    return row.repeat != first;
  });
  return day;
}

preparation::DistanceScatter scatterOf(const campaign::Campaign& day) {
  return preparation::distanceScatter(day, preparation::declaredNoise(day).value());
}

// 19 postures under five steps: 18 changes of three distances each under each step, 270 squares, worth 0.37 x 2/3 of
// them.
TEST(DistanceScatter, FindsTheNoiseOfReadings) {
  for (const double factor : {0.6, 1.0, 1.5, 2.5}) {
    const preparation::DistanceScatter found = scatterOf(dayReadOnce(81, factor));
    EXPECT_NEAR(found.degrees, 0.37 * 2.0 / 3.0 * 270.0, 1.0);
    // Three of its standard deviations.
    EXPECT_NEAR(found.ratio / (factor * factor), 1.0, 3.0 * std::sqrt(2.0 / found.degrees)) << factor;
    EXPECT_EQ(found.asDeclared(), factor == 1.0) << factor;
  }
}

TEST(DistanceScatter, AReflectorThatSlippedOrGivesUnderLoadIsNoNoise) {
  campaign::Campaign day = dayReadOnce(82, 1.0);
  const double before = scatterOf(day).ratio;
  std::map<std::pair<int, int>, Eigen::Vector3d> first;  // of the reflectors, by posture and step
  for (const campaign::LoadingReading& row : day.loading->rows) {
    if (row.target == 0) first[{row.pose, row.step}] = row.point;
  }
  // Along the line from the first reflector, which turns with the flange.
  for (campaign::LoadingReading& row : day.loading->rows) {
    const Eigen::Vector3d away = (row.point - first.at({row.pose, row.step})).normalized();
    if (row.target == 1 && row.pose > 7) row.point += 2e-3 * away;
    if (row.target == 2) row.point += 0.3e-3 * row.step * away;
  }
  const preparation::DistanceScatter after = scatterOf(day);
  EXPECT_NEAR(after.ratio / before, 1.0, 0.2);
  EXPECT_TRUE(after.asDeclared());
}

TEST(DistanceScatter, OneReflectorHasNoDistances) {
  campaign::Campaign day = dayReadOnce(83, 1.0);
  std::erase_if(day.loading->rows, [](const campaign::LoadingReading& row) { return row.target != 0; });
  EXPECT_EQ(scatterOf(day).degrees, 0.0);
}

// As the noise of a day: taken where the declared one is contradicted, and named.
TEST(DistanceScatter, StandsInForRepeats) {
  const auto noiseOf = [](const campaign::Campaign& day) { return preparation::prepareCampaign(day).noise; };
  const preparation::NoiseModel larger = noiseOf(dayReadOnce(84, 1.5)), declared = noiseOf(dayReadOnce(84, 1.0));
  EXPECT_NEAR(larger.along_factor, 1.5, 0.4);
  EXPECT_EQ(larger.along_factor, larger.across_factor);
  EXPECT_GT(larger.degrees, 30.0);
  EXPECT_NE(reports::words(larger.source).find("distances between reflectors ("), std::string::npos);
  EXPECT_EQ(declared.along_factor, 1.0);
  EXPECT_GT(declared.degrees, 30.0);
  EXPECT_NE(reports::words(declared.source).find("declared noise"), std::string::npos);
  // With repeats these tell it, along the beam and across it.
  const preparation::NoiseModel repeated = noiseOf(simulation::simulate(cleanDay(84, 1.5)));
  EXPECT_NE(reports::words(repeated.source).find("repeats ("), std::string::npos);
}

}  // namespace distance_scatter_test
}  // namespace stiffscope
