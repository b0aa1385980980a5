#include "core/interchange/nest_times.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace stiffscope {
namespace nest_times_test {

using namespace interchange;

/// Readings of nests 0, 1, ... at these times, by a clock of that last digit.
std::vector<campaign::NestReading> readings(const std::vector<std::pair<double, int>>& at) {
  std::vector<campaign::NestReading> rows;
  for (const auto& [time, nest] : at) rows.push_back({time, nest, Eigen::Vector3d::Zero(), rows.size() + 2});
  return rows;
}

MovedNests kept(std::vector<campaign::NestReading>& rows, double resolution) {
  return keepTimesApart(rows, std::vector<double>(rows.size(), resolution));
}

TEST(NestTimes, OtherTimesAndOtherNestsStay) {
  auto rows = readings({{1.00, 0}, {1.04, 0}, {1.04, 1}, {1.05, 0}});
  EXPECT_EQ(kept(rows, 0.01).count, 0u);
  EXPECT_EQ(rows[1].time_s, 1.04);
}

TEST(NestTimes, OneTimeIsToldApartWithinTheClocksLastDigit) {
  auto rows = readings({{1.04, 0}, {1.04, 0}, {1.05, 0}});
  const MovedNests moved = kept(rows, 0.01);
  EXPECT_EQ(moved.count, 1u);
  EXPECT_EQ(moved.first, 1u);
  EXPECT_GT(moved.farthest_s, 0.0);
  EXPECT_LT(moved.farthest_s, 0.01);
  EXPECT_EQ(rows[2].time_s, 1.05);
  // Whole seconds of a tracker that reads fifty times in one.
  auto often = readings(std::vector<std::pair<double, int>>(50, {3.0, 0}));
  EXPECT_LT(kept(often, 1.0).farthest_s, 1.0);
  for (std::size_t i = 1; i < often.size(); ++i) EXPECT_GT(often[i].time_s, often[i - 1].time_s + 0.9e-4);
}

TEST(NestTimes, WhatTheTableWouldRoundIntoOneIsToldApart) {
  auto rows = readings({{1.00001, 0}, {1.00002, 0}, {1.00003, 0}});
  EXPECT_EQ(kept(rows, 1e-5).count, 2u);
  std::set<long long> written;
  for (const campaign::NestReading& row : rows) written.insert(std::llround(row.time_s * 1e4));
  EXPECT_EQ(written.size(), 3u);
}

TEST(NestTimes, ALakhOfReadingsWithoutSecondsTakesNoTime) {
  auto rows = readings(std::vector<std::pair<double, int>>(100'000, {60.0, 0}));
  EXPECT_EQ(kept(rows, 60.0).count, 99'999u);
}

}  // namespace nest_times_test
}  // namespace stiffscope
