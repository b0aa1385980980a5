#include "core/preparation/rail.h"

#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include <random>

#include "core/campaign/check_campaign.h"
#include "core/io/input_error.h"

// The course of a carriage by its sweep, and readings referred to its zero. Readings are made here by hand.

namespace stiffscope {
namespace rail_test {

using Eigen::Vector3d;

const Vector3d kPerMetre = 1.0004 * Vector3d(0.6, 0.64, std::sqrt(1.0 - 0.36 - 0.4096));

campaign::Campaign onRail() {
  campaign::Campaign campaign;
  campaign.folder = "day";
  campaign.robot.rail = robot::Rail{"track", Vector3d::UnitX(), 0.0, 5.0};
  campaign.targets = {{"A", {}}, {"B", {}}, {"C", {}}};
  campaign.rail_sweep.emplace();
  campaign.rail_sweep->file = "rail_sweep.csv";
  const Vector3d places[] = {{3, 1, 1}, {3.2, 1.1, 0.8}, {3.1, 0.7, 1.3}};
  std::size_t line = 2;
  for (int stop = 0; stop < 11; ++stop) {
    for (int target = 0; target < 3; ++target) {
      campaign::RailReading row;
      row.index = std::to_string(stop);
      row.target = target;
      row.rail = 1.0 + 0.2 * stop;
      row.point = places[target] + row.rail * kPerMetre;
      row.line = line++;
      campaign.rail_sweep->rows.push_back(row);
    }
  }
  return campaign;
}

TEST(Rail, ItsCourseIsTheLineThatTheReadingsLieOn) {
  const auto course = preparation::fitRailCourse(onRail(), std::nullopt);
  ASSERT_TRUE(course);
  EXPECT_LT((course->per_metre - kPerMetre).norm(), 1e-13);  // rounding of a solution in 12 unknowns
  EXPECT_NEAR(course->scale(), 1.0004, 1e-13);
  EXPECT_LT(course->farthest, 1e-13);
  EXPECT_DOUBLE_EQ(course->lowest, 1.0);
  EXPECT_DOUBLE_EQ(course->highest, 3.0);
  EXPECT_EQ(course->readings, 33);
}

// Of one coordinate of a line through n stops of three reflectors the slope's variance is sigma^2 / (3 sum (r -
// mean)^2).
TEST(Rail, ItsUncertaintyIsThatOfASlope) {
  const metrology::TrackerNoise noise{10e-6, 0.0, 10e-6, 0.0, Vector3d::Zero()};
  const auto course = preparation::fitRailCourse(onRail(), noise);
  ASSERT_TRUE(course);
  double spread = 0.0;
  for (int stop = 0; stop < 11; ++stop) spread += 3.0 * std::pow(0.2 * (stop - 5), 2);
  EXPECT_NEAR(course->covariance(0, 0) / (1e-10 / spread), 1.0, 1e-9);
  EXPECT_NEAR(course->covariance(0, 1) * spread / 1e-10, 0.0, 1e-9);
}

// Chi-square of the three numbers of the direction, over 400 sweeps: the mean is 3, its standard deviation sqrt(6/400).
TEST(Rail, ItsUncertaintyIsWhatNoiseDoes) {
  const metrology::TrackerNoise noise{5e-6, 1e-6, 15e-6, 5e-6, Vector3d(0.5, -1.0, 0.2)};
  std::mt19937_64 random(20261125);
  std::normal_distribution<double> normal;
  double sum = 0.0;
  constexpr int kSweeps = 400;
  for (int k = 0; k < kSweeps; ++k) {
    campaign::Campaign day = onRail();
    for (campaign::RailReading& row : day.rail_sweep->rows) {
      const Eigen::Matrix3d root = noise.covarianceAt(row.point).llt().matrixL();
      row.point += root * Vector3d(normal(random), normal(random), normal(random));
    }
    const auto course = preparation::fitRailCourse(day, noise);
    const Vector3d error = course->per_metre - kPerMetre;
    // What is scaled up by chance residuals makes it wider by a few per cent, never narrower.
    sum += error.dot(course->covariance.inverse() * error);
  }
  EXPECT_LT(sum / kSweeps, 3.0 + 4.0 * std::sqrt(6.0 / kSweeps));
  EXPECT_GT(sum / kSweeps, 0.9 * (3.0 - 4.0 * std::sqrt(6.0 / kSweeps)));
}

TEST(Rail, AWaveIsFoundAcrossItAndWidensItsUncertainty) {
  campaign::Campaign day = onRail();
  const Vector3d across = kPerMetre.cross(Vector3d::UnitZ()).normalized();
  for (campaign::RailReading& row : day.rail_sweep->rows)
    row.point += 1e-3 * std::sin(2.0 * std::numbers::pi * row.rail) * across;
  const metrology::TrackerNoise noise{10e-6, 0.0, 10e-6, 0.0, Vector3d::Zero()};
  const auto course = preparation::fitRailCourse(day, noise), straight = preparation::fitRailCourse(onRail(), noise);
  EXPECT_GT(course->across_rms, 0.5e-3);
  EXPECT_LT(course->along_rms, 1e-6);
  EXPECT_GT(course->covariance(0, 0), 100.0 * straight->covariance(0, 0));
}

// Stops that miss by 50 um along and 80 um across (each direction) under 10 um of noise, over 300 sweeps.
TEST(Rail, WhatItsStopsMissIsToldFromNoise) {
  const metrology::TrackerNoise noise{10e-6, 0.0, 10e-6, 0.0, Vector3d::Zero()};
  std::mt19937_64 random(20261126);
  std::normal_distribution<double> normal;
  const Vector3d along = kPerMetre.normalized();
  double by_stop = 0.0, aside = 0.0;
  constexpr int kSweeps = 300;
  for (int k = 0; k < kSweeps; ++k) {
    campaign::Campaign day = onRail();
    Vector3d missed = Vector3d::Zero();
    for (campaign::RailReading& row : day.rail_sweep->rows) {
      if (row.target == 0) {
        const Vector3d draw(normal(random), normal(random), normal(random));
        missed = 80e-6 * draw + (50e-6 - 80e-6) * along.dot(draw) * along;
      }
      row.point += missed + 10e-6 * Vector3d(normal(random), normal(random), normal(random));
    }
    const auto course = preparation::fitRailCourse(day, noise);
    by_stop += along.dot(course->of_stop * along) / kSweeps;
    aside += 0.5 * (course->of_stop.trace() - along.dot(course->of_stop * along)) / kSweeps;
  }
  // A variance by nine degrees of freedom: sd sqrt(2 / 9) of itself, over 300 sweeps 2.7 %; four of those.
  EXPECT_NEAR(by_stop / (50e-6 * 50e-6), 1.0, 0.11);
  EXPECT_NEAR(aside / (80e-6 * 80e-6), 1.0, 0.11);
}

TEST(Rail, ReadingsAreReferredToTheCarriageAtZero) {
  campaign::Campaign day = onRail();
  const Vector3d place(2.5, 0.3, 1.7);
  day.states = campaign::States{"states.csv", campaign::PointFrame::tracker, {}};
  day.loading = campaign::Loading{"loading.csv", campaign::PointFrame::tracker, {}};
  for (int pose = 0; pose < 3; ++pose) {
    campaign::State state(6);
    state.pose = pose;
    state.rail = 0.5 + pose;
    state.extras().tool_pose.position.setZero();
    day.states->rows.push_back(state);
    campaign::LoadingReading row;
    row.pose = pose;
    row.point = place + state.rail * kPerMetre;
    day.loading->rows.push_back(row);
  }
  campaign::Campaign in_base = day;
  preparation::referToCarriageAtZero(preparation::fitRailCourse(day, std::nullopt), day);
  for (const campaign::LoadingReading& row : day.loading->rows) EXPECT_LT((row.point - place).norm(), 1e-12);
  for (const campaign::State& row : day.states->rows) {
    EXPECT_EQ(row.rail, 0.0);
    EXPECT_EQ(row.carriage, 0.5 + row.pose);
    EXPECT_FALSE(row.extras().tool_pose.hasPosition());
  }
  // Once more changes nothing.
  const campaign::Campaign once = day;
  preparation::referToCarriageAtZero(preparation::fitRailCourse(day, std::nullopt), day);
  for (std::size_t i = 0; i < once.loading->rows.size(); ++i)
    EXPECT_EQ(day.loading->rows[i].point, once.loading->rows[i].point);
  for (const campaign::State& row : day.states->rows) EXPECT_EQ(row.carriage, 0.5 + row.pose);
  // And back: every reading where it was, at the positions that were reported.
  campaign::Campaign back = once;
  preparation::referToWhereItStood(preparation::fitRailCourse(back, std::nullopt), back);
  for (const campaign::LoadingReading& row : back.loading->rows)
    EXPECT_LT((row.point - place - (0.5 + row.pose) * kPerMetre).norm(), 1e-12);
  for (const campaign::State& row : back.states->rows) EXPECT_EQ(row.rail, 0.5 + row.pose);
  preparation::referToCarriageAtZero(preparation::fitRailCourse(back, std::nullopt), back);
  for (std::size_t i = 0; i < once.loading->rows.size(); ++i) {
    EXPECT_LT((back.loading->rows[i].point - once.loading->rows[i].point).norm(), 1e-12);
    EXPECT_LT((back.loading->rows[i].from - once.loading->rows[i].from).norm(), 1e-12);
  }
  // Points of base_link go by the URDF's direction.
  in_base.loading->frame = campaign::PointFrame::base_link;
  for (int pose = 0; pose < 3; ++pose)
    in_base.loading->rows[static_cast<std::size_t>(pose)].point = place + (0.5 + pose) * Vector3d::UnitX();
  preparation::referToCarriageAtZero(std::nullopt, in_base);
  for (const campaign::LoadingReading& row : in_base.loading->rows) EXPECT_LT((row.point - place).norm(), 1e-12);
}

/// The message with which a campaign is refused; empty where it is not.
std::string refusal(const campaign::Campaign& campaign) {
  std::vector<std::string> warnings;
  try {
    campaign::checkCampaign(campaign, warnings);
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "";
}

campaign::Campaign withStates(double first, double second) {
  campaign::Campaign day = onRail();
  day.pose_ids = {"a", "b"};
  day.states = campaign::States{"states.csv", campaign::PointFrame::tracker, {}};
  day.loading = campaign::Loading{"loading.csv", campaign::PointFrame::tracker, {}};
  for (const double rail : {first, second}) {
    campaign::State state(0);
    state.pose = static_cast<int>(day.states->rows.size());
    state.rail = rail;
    state.line = day.states->rows.size() + 2;
    day.states->rows.push_back(state);
    campaign::LoadingReading row;
    row.pose = state.pose;
    day.loading->rows.push_back(row);
  }
  return day;
}

TEST(Rail, TablesThatDoNotSayWhereTheCarriageStoodAreRefused) {
  EXPECT_EQ(refusal(withStates(1.0, 2.0)), "");
  EXPECT_EQ(refusal(withStates(1.0, campaign::kNotGiven)),
            "day/states.csv:1: rail_mm: expected a column rail_mm, the position of 'track': the arm stands on a rail");
  campaign::Campaign still = withStates(1.0, 1.0);
  still.rail_sweep.reset();
  EXPECT_EQ(refusal(still), "");
  campaign::Campaign unswept = withStates(1.0, 2.0);
  unswept.rail_sweep.reset();
  EXPECT_EQ(refusal(unswept),
            "day/campaign.xml: rail_sweep: expected a rail_sweep, which shows how the carriage goes in the tracker's "
            "frame: the arm was read at 1000.0 to 2000.0 mm of 'track'");
  campaign::Campaign short_sweep = withStates(1.0, 2.0);
  for (campaign::RailReading& row : short_sweep.rail_sweep->rows) row.rail = 1.0 + 0.01 * (row.rail - 1.0);
  EXPECT_EQ(refusal(short_sweep),
            "day/rail_sweep.csv: rail_mm: expected at least 3 positions of the carriage over 100 mm or more; there are "
            "11 over 20.0 mm");
}

TEST(Rail, PositionsInAnotherUnitAreNamed) {
  for (const auto& [millimetres, name] : {std::pair(1000.0, "metres"), std::pair(25.4, "inches")}) {
    campaign::Campaign day = withStates(1.0, 2.0);
    for (campaign::RailReading& row : day.rail_sweep->rows) row.rail /= millimetres;
    EXPECT_NE(refusal(day).find(std::string("as if these were ") + name), std::string::npos) << refusal(day);
  }
}

TEST(Rail, AnArmThatStandsOnNoneHasNoCarriage) {
  campaign::Campaign day = withStates(1.0, 2.0);
  day.robot.rail.reset();
  EXPECT_EQ(refusal(day),
            "day/states.csv:3: rail_mm: expected an arm that stands still: the URDF has no prismatic joint before the "
            "arm's joints");
  day = withStates(1.0, 1.0);
  day.robot.rail.reset();
  EXPECT_EQ(refusal(day),
            "day/rail_sweep.csv: rail_sweep: expected an arm on a rail: the URDF has no prismatic joint before the "
            "arm's joints");
}

}  // namespace rail_test
}  // namespace stiffscope
