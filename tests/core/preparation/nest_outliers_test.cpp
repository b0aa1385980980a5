#include "core/preparation/nest_network.h"

#include <gtest/gtest.h>
#include "core/preparation/drift_nests.h"
#include "core/preparation/prepare.h"
#include "core/preparation/remarks.h"
#include "tests/metrology/simulated_points.h"

// Floor nests of a station that drifts, made here: by a motion and a noise of their own.

namespace stiffscope {
namespace nest_outliers_test {

constexpr double kAlong = 6e-6, kAcross = 18e-6;  // m, one sigma
constexpr double kRound = 20.0;                   // s

struct NestDay {
  int nests = 4, rounds = 60;
  double drift = 81e-6;  ///< m, over the day, at the arm
  double turn = 5e-6;    ///< rad, over the day, about the vertical through the arm
  std::uint64_t seed = 1;
};

const Eigen::Vector3d kArm{3.0, 0.5, 0.2};

campaign::Campaign nestDay(const NestDay& day) {
  campaign::Campaign campaign;
  campaign.tracker = campaign::Tracker{"tracker", kAlong, 0.0, kAcross, 0.0, Eigen::Vector3d::Zero()};
  campaign.nests = campaign::Nests{"nests.csv", campaign::PointFrame::tracker, {}};
  campaign.targets.push_back({"P10", {}});
  campaign.pose_ids.push_back("1");
  campaign.loading = campaign::Loading{"loading.csv", campaign::PointFrame::tracker, {}};
  campaign.loading->rows.push_back({0, 0, 1, 0, 1.0, kArm});
  const std::vector<Eigen::Vector3d> places{
      {3.3, -0.2, -1.2}, {0.9, 1.3, -1.2}, {4.6, 0.3, -1.2}, {1.2, 3.1, -0.7}, {4.4, 2.6, -1.1}};
  Noise noise(day.seed);
  std::size_t line = 2;
  for (int round = 0; round < day.rounds; ++round) {
    const double share = static_cast<double>(round) / (day.rounds - 1);
    const Eigen::AngleAxisd turned(share * day.turn, Eigen::Vector3d::UnitZ());
    for (int nest = 0; nest < day.nests; ++nest) {
      Eigen::Vector3d point = kArm + turned * (places[static_cast<std::size_t>(nest)] - kArm);
      point.x() += share * day.drift;
      point += noise.draw(seenFromOrigin(point, kAlong, kAcross));
      campaign.nests->rows.push_back({round * kRound + nest, nest, point, line++});
    }
  }
  for (int nest = 0; nest < day.nests; ++nest) campaign.nest_ids.push_back("N" + std::to_string(nest + 1));
  return campaign;
}

campaign::NestReading& reading(campaign::Campaign& campaign, int round, int nest) {
  for (campaign::NestReading& row : campaign.nests->rows) {
    if (row.nest == nest && row.time_s == round * kRound + nest) return row;
  }
  throw std::out_of_range("no such reading");
}

std::vector<std::size_t> linesOf(const preparation::NestOutliers& found) {
  std::vector<std::size_t> lines;
  for (const preparation::RejectedReading& one : found.readings) lines.push_back(one.line);
  return lines;
}

// The case that was met: five of 2978 readings off by 300 mm, a drift of 81 um.
TEST(NestOutliers, FiveOfThreeThousandLeaveTheDriftAsItWas) {
  NestDay day;
  day.rounds = 745;
  campaign::Campaign good = nestDay(day);
  good.nests->rows.resize(2978);
  campaign::Campaign spoilt = good;
  std::vector<std::size_t> lines;
  Noise directions(3);
  using RoundAndNest = std::pair<int, int>;
  for (const auto& [round, nest] : std::vector<RoundAndNest>{{0, 1}, {111, 0}, {112, 0}, {400, 3}, {743, 2}}) {
    campaign::NestReading& row = reading(spoilt, round, nest);
    row.point += 0.3 * directions.direction();
    lines.push_back(row.line);
  }
  const preparation::NestOutliers found = preparation::nestOutliers(spoilt);
  ASSERT_TRUE(found.tested);
  EXPECT_EQ(linesOf(found), lines);
  for (const preparation::RejectedReading& one : found.readings) {
    EXPECT_EQ(one.file, "nests.csv");
    ASSERT_TRUE(one.reason.is(preparation::RemarkId::stands_from_nest));
    EXPECT_NEAR(std::get<double>(one.reason.values.at(0)), 0.3, 1e-4);  // m; drift and noise are less
  }
  EXPECT_TRUE(preparation::nestOutliers(good).readings.empty());
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(spoilt);
  EXPECT_TRUE(prepared.preparation.drift.taken_off);
  // A line through 745 rounds, each known to about 15 um at the arm: to about 1 um at its end; ten of them.
  EXPECT_NEAR(prepared.preparation.drift.displacement, day.drift, 10e-6);
}

// All five the same way, and of one nest: not one that was moved, because it is back in between.
TEST(NestOutliers, TheSameErrorAgainAndAgain) {
  campaign::Campaign spoilt = nestDay({});
  std::vector<std::size_t> lines;
  for (const int round : {3, 9, 20, 40, 59}) {
    campaign::NestReading& row = reading(spoilt, round, 2);
    row.point += Eigen::Vector3d(0.3, 0.0, 0.0);
    lines.push_back(row.line);
  }
  EXPECT_EQ(linesOf(preparation::nestOutliers(spoilt)), lines);
}

TEST(NestOutliers, AMillimetreInThePlaneOfTheNestsIsTold) {
  for (const Eigen::Vector3d& off : {Eigen::Vector3d(1e-3, 0, 0), Eigen::Vector3d(0, 1e-3, 0)}) {
    campaign::Campaign spoilt = nestDay({5, 7});
    campaign::NestReading& row = reading(spoilt, 3, 1);
    row.point += off;
    EXPECT_EQ(linesOf(preparation::nestOutliers(spoilt)), std::vector<std::size_t>{row.line}) << off.transpose();
  }
}

// Across it distances do not see an error, the motion does: five nests leave two in doubt, and three for the motion.
TEST(NestOutliers, AMillimetreAcrossThePlaneIsFoundByFive) {
  campaign::Campaign spoilt = nestDay({5, 7});
  campaign::NestReading& row = reading(spoilt, 3, 1);
  row.point.z() += 1e-3;
  const std::vector<std::size_t> lines = linesOf(preparation::nestOutliers(spoilt));
  EXPECT_LE(lines.size(), 2u);
  EXPECT_NE(std::find(lines.begin(), lines.end(), row.line), lines.end());
  for (const std::size_t line : lines) EXPECT_TRUE(line >= 17 && line < 22) << line;  // the fourth round's
  EXPECT_EQ(preparation::prepareCampaign(spoilt).drift.rounds.epochs.size(), 7u);
}

// Three of four make a plane with any fourth: across it nobody knows who is wrong, and the round is not used.
TEST(NestOutliers, OfFourNestsAcrossTheirPlaneTheRoundGoes) {
  campaign::Campaign spoilt = nestDay({4, 7});
  campaign::NestReading& row = reading(spoilt, 3, 1);
  row.point.z() += 1e-3;
  const preparation::NestOutliers found = preparation::nestOutliers(spoilt);
  const std::vector<std::size_t> lines = linesOf(found);
  EXPECT_GE(lines.size(), 2u);
  EXPECT_NE(std::find(lines.begin(), lines.end(), row.line), lines.end());
  for (const std::size_t line : lines) EXPECT_TRUE(line >= 14 && line < 18) << line;  // the fourth round's
  for (const preparation::RejectedReading& one : found.readings)
    EXPECT_TRUE(one.reason.is(preparation::RemarkId::one_of_round_wrong));
  EXPECT_EQ(preparation::prepareCampaign(spoilt).drift.rounds.epochs.size(), 6u);
}

// Two of a round of four: distances to the two others, which agree, are wrong of both.
TEST(NestOutliers, TwoInOneRound) {
  campaign::Campaign spoilt = nestDay({});
  campaign::NestReading &one = reading(spoilt, 30, 0), &other = reading(spoilt, 30, 2);
  one.point.x() += 0.2;
  other.point.y() -= 0.1;
  EXPECT_EQ(linesOf(preparation::nestOutliers(spoilt)), (std::vector<std::size_t>{one.line, other.line}));
}

TEST(NestOutliers, OfThreeNestsTheOneInTheirPlaneIsToldAndTheRoundIsLeftOut) {
  campaign::Campaign spoilt = nestDay({3, 20});
  campaign::NestReading& row = reading(spoilt, 7, 1);
  row.point.x() += 0.3;
  const preparation::NestOutliers found = preparation::nestOutliers(spoilt);
  EXPECT_EQ(linesOf(found), std::vector<std::size_t>{row.line});
  EXPECT_EQ(found.rounds, 20);
  EXPECT_EQ(found.rounds_of_three, 20);  // and it says so
  EXPECT_EQ(preparation::prepareCampaign(spoilt).drift.rounds.epochs.size(), 19u);
}

TEST(NestOutliers, ANestThatWasMovedIsNoSingleReading) {
  for (const int first : {30, 58}) {
    campaign::Campaign moved = nestDay({});
    for (campaign::NestReading& row : moved.nests->rows) {
      if (row.nest == 2 && row.time_s >= first * kRound) row.point.x() += 0.5e-3;
    }
    EXPECT_TRUE(preparation::nestOutliers(moved).readings.empty()) << first;
    const preparation::StationMotion station = preparation::prepareCampaign(moved).drift.rounds;
    ASSERT_TRUE(station.moved_nest) << first;
    EXPECT_EQ(*station.moved_nest, 2);
  }
}

TEST(NestOutliers, AStationThatJumpsIsNoOutlier) {
  campaign::Campaign jumped = nestDay({});
  for (campaign::NestReading& row : jumped.nests->rows) {
    if (row.time_s >= 31 * kRound) row.point += Eigen::Vector3d(0.4e-3, -1e-3, 0.2e-3);
  }
  EXPECT_TRUE(preparation::nestOutliers(jumped).readings.empty());
}

// The level is 0.01 / 21 a day: of 300 days 0.14 have one. Five are beyond one in a million.
TEST(NestOutliers, CleanDaysLoseNothing) {
  int with_one = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    NestDay day{4, 12};
    day.seed = seed;
    with_one += !preparation::nestOutliers(nestDay(day)).readings.empty();
  }
  EXPECT_LE(with_one, 3);
}

TEST(NestOutliers, SaysWhatIsMissing) {
  campaign::Campaign none = nestDay({});
  none.nests.reset();
  EXPECT_TRUE(preparation::nestOutliers(none).reason.is(preparation::RemarkId::no_floor_nests));
  EXPECT_TRUE(preparation::nestOutliers(nestDay({4, 2})).reason.is(preparation::RemarkId::too_few_rounds_to_tell));
  campaign::Campaign undeclared = nestDay({});
  undeclared.tracker.reset();
  EXPECT_TRUE(preparation::nestOutliers(undeclared).reason.is(preparation::RemarkId::tracker_noise_not_declared));
}

}  // namespace nest_outliers_test
}  // namespace stiffscope
