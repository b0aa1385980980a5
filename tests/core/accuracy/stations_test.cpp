// Days without a load whose postures were read from two stations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/accuracy/diagnose_accuracy.h"
#include "metrology/rigid_motion.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace stations_test {

using calibration::UnloadedEffect;

constexpr double kShift = 40e-6, kTurn = 20e-6;  ///< m, rad: to which the nests tell the second station's pose
constexpr int kPostures = 80, kFirstOfB = 35;

/// A clean day of two stations as they were joined, the nests still. From kFirstOfB on station B reads, which stands
/// elsewhere than it was joined: by `shift` (m) and `turn` (rad).
preparation::PreparedCampaign joinedDay(std::uint64_t seed, const Eigen::Vector3d& shift, const Eigen::Vector3d& turn) {
  Noise noise(seed);
  UnloadedSpec spec;
  spec.built = spec.nominal.disturbed(noise, 0.2e-3, 0.1e-3);
  spec.postures = kPostures;
  const Eigen::Vector3d centre = spec.tracker_from_base.translation(), place_of_b(6.0, 2.5, 0.1);
  preparation::PreparedCampaign prepared;
  prepared.campaign = unloadedCampaign(spec, noise);
  campaign::StationPlace second;
  second.id = "B";
  second.first_from_station.translation() = place_of_b;
  second.centre = centre;
  second.covariance.diagonal() << Eigen::Vector3d::Constant(kTurn * kTurn), Eigen::Vector3d::Constant(kShift * kShift);
  prepared.campaign.stations = {{"A"}, second};
  for (campaign::LoadingReading& reading : prepared.campaign.loading->rows) {
    if (reading.pose < kFirstOfB) continue;
    reading.station = 1;
    reading.from = place_of_b;
    reading.point += turn.cross(reading.point - centre) + shift;
  }
  prepared.drift.course = preparation::StationCourse::still;
  return prepared;
}

/// Two standard uncertainties of the pose in one shift, one and a half in two turns.
preparation::PreparedCampaign uncertainDay(std::uint64_t seed) {
  return joinedDay(seed, {0.5 * kShift, 0.0, -2.0 * kShift}, {1.5 * kTurn, -1.5 * kTurn, 0.0});
}

const accuracy::AccuracyEntry* named(const accuracy::AccuracyDiagnosis& result, UnloadedEffect effect) {
  for (const accuracy::AccuracyEntry& entry : result.verdict) {
    if (std::find(entry.effects.begin(), entry.effects.end(), effect) != entry.effects.end()) return &entry;
  }
  return nullptr;
}

// Four times the noise at the reflectors, and nothing that the machine did.
TEST(StationsOfAnUnloadedDay, WhatTheirPosesMayBeOffByIsNoEffect) {
  for (const std::uint64_t seed : {61u, 62u, 63u}) {
    SCOPED_TRACE(seed);
    const accuracy::AccuracyDiagnosis result = accuracy::diagnoseAccuracy(uncertainDay(seed));
    ASSERT_TRUE(result.usable);
    EXPECT_TRUE(result.verdict.empty());
    EXPECT_TRUE(result.calibration.best().fit.parts.empty());
    // The noise is that of the readings, and what is left is no more.
    EXPECT_NEAR(result.gap.noise, 20e-6, 1e-9);
    EXPECT_NEAR(result.gap.before, 20e-6, 5e-6);
  }
}

// As a day would be judged whose stations were known without any doubt.
TEST(StationsOfAnUnloadedDay, WithoutThatDoubtItIsAFrameThatMoved) {
  preparation::PreparedCampaign prepared = uncertainDay(61);
  prepared.campaign.stations[1].covariance.setZero();
  const accuracy::AccuracyDiagnosis result = accuracy::diagnoseAccuracy(prepared);
  const accuracy::AccuracyEntry* frame = named(result, UnloadedEffect::frame_error);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->detail, "robot or station 'B'");
}

TEST(StationsOfAnUnloadedDay, AFrameThatMovedByMoreIsNamed) {
  const accuracy::AccuracyDiagnosis result =
      accuracy::diagnoseAccuracy(joinedDay(64, {0.6e-3, -0.5e-3, 0.8e-3}, {0.0, 200e-6, -100e-6}));
  const accuracy::AccuracyEntry* frame = named(result, UnloadedEffect::frame_error);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->detail, "robot or station 'B'");
}

/// The arm that read from both is found with the pose, within its uncertainty, and that counts the pose's.
TEST(StationsOfAnUnloadedDay, ThePoseIsFoundWithTheArm) {
  const preparation::PreparedCampaign prepared = uncertainDay(65);
  const calibration::Calibration result = calibration::calibrate(prepared, {});
  const calibration::ArmFit& fit = result.geometry().fit;
  ASSERT_EQ(fit.stations.size(), 6u);
  double squares = 0.0;
  for (Eigen::Index k = 0; k < 6; ++k) {
    const double size = fit.sizes[k];
    squares += size * size;
    EXPECT_LT(fit.sd(static_cast<int>(fit.stationsAt() + k)), 1.0);
  }
  EXPECT_NEAR(std::sqrt(squares), std::sqrt(0.25 + 4.0 + 2.0 * 2.25), 1.0);
  // The same day with stations that nobody doubts has as many unknowns of the arm, and claims to know them better.
  preparation::PreparedCampaign sure = prepared;
  sure.campaign.stations[1].covariance.setZero();
  for (campaign::LoadingReading& reading : sure.campaign.loading->rows) {
    if (reading.station == 1)
      reading.point -=
          Eigen::Vector3d(1.5 * kTurn, -1.5 * kTurn, 0.0).cross(reading.point - prepared.campaign.stations[1].centre) +
          Eigen::Vector3d(0.5 * kShift, 0.0, -2.0 * kShift);
  }
  const calibration::Calibration other = calibration::calibrate(sure, {});
  EXPECT_TRUE(other.geometry().fit.stations.empty());
  EXPECT_EQ(other.geometry().fit.parameters, fit.parameters);
  const int base = static_cast<int>(fit.places().baseAt());
  for (int k = base; k < base + 6; ++k) EXPECT_GT(fit.sd(k), other.geometry().fit.sd(k)) << k;
}

}  // namespace stations_test
}  // namespace stiffscope
