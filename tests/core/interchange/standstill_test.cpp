#include "core/interchange/day_description.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace stiffscope {
namespace standstill_test {

using namespace interchange;

constexpr double kDeg = std::numbers::pi / 180.0;
const StandstillOptions kUsual{0.02 * kDeg, 1.0};

/// Samples of one joint's course (deg) at 100 Hz from time 10 s; the other joints stand.
std::vector<JointSample> logOf(const std::vector<double>& degrees) {
  std::vector<JointSample> samples;
  for (std::size_t i = 0; i < degrees.size(); ++i) {
    JointSample sample(6);
    sample.time_s = 10.0 + 0.01 * static_cast<double>(i);
    sample.figures[2] = degrees[i] * kDeg;
    samples.push_back(sample);
  }
  return samples;
}

/// Stands at each place for so many seconds, and moves by 10 deg/s between.
std::vector<double> course(const std::vector<std::pair<double, double>>& places_and_seconds) {
  std::vector<double> degrees;
  for (const auto& [place, seconds] : places_and_seconds) {
    if (!degrees.empty()) {
      const double from = degrees.back(), step = place > from ? 0.1 : -0.1;
      for (int i = 1; std::abs(place - from - i * step) > 0.05; ++i) degrees.push_back(from + i * step);
    }
    degrees.insert(degrees.end(), static_cast<std::size_t>(100 * seconds), place);
  }
  return degrees;
}

TEST(Standstill, FirstAndLastSampleThatStand) {
  const auto samples = logOf(course({{0, 2.0}, {5, 3.0}, {-5, 1.5}}));
  const auto found = standstillsOf(samples, kUsual);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].first, 0u);
  EXPECT_EQ(found[0].last, 199u);
  EXPECT_EQ(found[1].first, 200u + 49u);  // 49 samples between 0 and 5 deg
  EXPECT_EQ(found[1].last, 249u + 299u);
  EXPECT_DOUBLE_EQ(found[1].from_s, 12.49);
  EXPECT_EQ(found[2].last, samples.size() - 1);
}

TEST(Standstill, PausesAreTooShortAndSlowMotionIsNone) {
  EXPECT_EQ(standstillsOf(logOf(course({{0, 2.0}, {5, 0.8}, {10, 2.0}})), kUsual).size(), 2u);
  std::vector<double> slow;
  for (int i = 0; i < 2000; ++i) slow.push_back(0.001 * i);  // 0.1 deg/s leaves 0.02 deg in 0.2 s
  EXPECT_TRUE(standstillsOf(logOf(slow), kUsual).empty());
  EXPECT_TRUE(standstillsOf({}, kUsual).empty());
}

TEST(Standstill, NoiseOfEncodersStandsAndItsMeanIsTheFigure) {
  auto degrees = course({{0, 2.0}, {5, 2.0}});
  std::mt19937 draw(3);
  std::uniform_real_distribution<double> noise(-0.004, 0.004);
  for (double& one : degrees) one += noise(draw);
  const auto samples = logOf(degrees);
  const auto found = standstillsOf(samples, kUsual);
  ASSERT_EQ(found.size(), 2u);
  // The mean of 200 even draws of +-0.004 deg has a deviation of 0.004 / sqrt(3 * 200) deg; six of them.
  EXPECT_NEAR(meanFigures(samples, found[1].first, found[1].last)[2], 5 * kDeg, 6 * 0.004 / std::sqrt(600.0) * kDeg);
}

TEST(Standstill, EqualFiguresAreTheirMeanToTheLastDigit) {
  const auto samples = logOf(std::vector<double>(1000, 33.123456789));
  EXPECT_EQ(meanFigures(samples, 0, 999), samples[0].figures);
}

TEST(Standstill, TurnsOfToolPosesAreAveragedAcross180Degrees) {
  std::vector<JointSample> samples(2, JointSample(6));
  samples[0].tool_pose = {{1.0, 2.0, 3.0}, {179.998 * kDeg, -45.0 * kDeg, 0.0}};
  samples[1].tool_pose = {{1.0, 2.002, 3.0}, {-179.998 * kDeg, -45.0 * kDeg, 0.0}};
  const campaign::StatedPose mean = meanToolPose(samples, 0, 1);
  EXPECT_NEAR(mean.position.y(), 2.001, 1e-15);
  EXPECT_NEAR(std::abs(mean.rpy.x()), 180.0 * kDeg, 1e-9);  // the square of what they are apart is left out
  EXPECT_NEAR(mean.rpy.y(), -45.0 * kDeg, 1e-9);
  EXPECT_EQ(meanToolPose(samples, 0, 0).rpy, samples[0].tool_pose.rpy);
  samples[1].tool_pose = {};
  EXPECT_FALSE(meanToolPose(samples, 0, 1).hasPosition());
}

/// Standstills that last and follow by chance, and readings within them by a clock that is behind.
struct TwoClocks {
  std::vector<Standstill> stills;
  std::vector<ReadingTime> readings;

  TwoClocks(double ahead_s, int count, int readings_each, unsigned seed) {
    std::mt19937 draw(seed);
    std::uniform_real_distribution<double> stay(8.0, 20.0), move(3.0, 9.0), within(0.0, 1.0);
    double now = 100.0;
    for (int i = 0; i < count; ++i) {
      const double until = now + stay(draw);
      stills.push_back({0, 0, now, until});
      for (int k = 0; k < readings_each; ++k)
        readings.push_back({std::floor(now + within(draw) * (until - now) - ahead_s), 1.0});
      now = until + move(draw);
    }
  }
};

TEST(ClockOffset, LiesWithinItsUncertainty) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const TwoClocks clocks(3.9, 30, 5, seed);
    const auto offsets = possibleOffsets(clocks.readings, clocks.stills, 0.8);
    ASSERT_FALSE(offsets.empty());
    EXPECT_LE(std::abs(offsets[0].offset_s - 3.9), offsets[0].uncertainty_s) << seed;
    EXPECT_LT(offsets[0].uncertainty_s, 2.0);
    EXPECT_GE(offsets[0].inside, 149u);
    // The arm stands three quarters of its time: others serve for many readings by chance, none for nearly all.
    for (std::size_t i = 1; i < offsets.size(); ++i) EXPECT_LT(offsets[i].inside, 140u) << seed;
  }
}

TEST(ClockOffset, ARhythmThatRepeatsHasSeveral) {
  std::vector<Standstill> stills;
  std::vector<ReadingTime> readings;
  for (int i = 0; i < 40; ++i) {
    stills.push_back({0, 0, 20.0 * i, 20.0 * i + 12.0});
    for (int k = 0; k < 3; ++k) readings.push_back({20.0 * i + 2.0 + 4.0 * k, 0.1});
  }
  const auto offsets = possibleOffsets(readings, stills, 0.8);
  ASSERT_GE(offsets.size(), 3u);
  EXPECT_NEAR(offsets[0].offset_s, 0.0, offsets[0].uncertainty_s);
  EXPECT_EQ(offsets[0].inside, 120u);
  EXPECT_EQ(offsets[1].inside, 117u);  // one standstill later or earlier
  EXPECT_NEAR(std::abs(offsets[1].offset_s), 20.0, offsets[1].uncertainty_s);
}

TEST(ClockOffset, TwentyThousandReadingsAreAllHeard) {
  // More than are looked at for a first guess: the bounds still come from all of them.
  const TwoClocks clocks(-7123.4, 400, 60, 5);
  ASSERT_EQ(clocks.readings.size(), 24'000u);
  const auto offsets = possibleOffsets(clocks.readings, clocks.stills, 0.8);
  ASSERT_FALSE(offsets.empty());
  EXPECT_LE(std::abs(offsets[0].offset_s + 7123.4), offsets[0].uncertainty_s);
  EXPECT_LT(offsets[0].uncertainty_s, 1.5);
  EXPECT_GE(offsets[0].inside, 23'880u);  // all but half a per cent
}

TEST(ClockOffset, BetweenTwoStandstillsAReadingCountsOnce) {
  // Half a second lies between them, and times have whole seconds.
  const std::vector<Standstill> stills{{0, 0, 0.0, 10.0}, {0, 0, 10.5, 20.0}, {0, 0, 20.5, 31.0}};
  std::vector<ReadingTime> readings;
  for (int i = 0; i < 31; ++i) readings.push_back({static_cast<double>(i), 1.0});
  for (const ClockOffset& offset : possibleOffsets(readings, stills, 0.1)) EXPECT_LE(offset.inside, readings.size());
}

TEST(ClockOffset, NothingGivesNone) {
  const TwoClocks clocks(0.0, 3, 2, 1);
  EXPECT_TRUE(possibleOffsets({}, clocks.stills, 0.8).empty());
  EXPECT_TRUE(possibleOffsets(clocks.readings, {}, 0.8).empty());
}

}  // namespace standstill_test
}  // namespace stiffscope
