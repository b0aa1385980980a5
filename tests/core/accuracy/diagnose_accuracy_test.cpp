#include "core/accuracy/diagnose_accuracy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/campaign/read_campaign.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace diagnose_accuracy_test {

using accuracy::AccuracyDiagnosis;
using calibration::UnloadedEffect;

/// A machine of its own for each seed, near enough to its URDF that this is no finding. Effects are some times the 20
/// um of noise: what is named of smaller ones is a matter of luck, which `known_causes` counts.
UnloadedSpec machine(Noise& noise, int postures) {
  UnloadedSpec spec;
  spec.built = spec.nominal.disturbed(noise, 0.2e-3, 0.1e-3);
  spec.postures = postures;
  return spec;
}

AccuracyDiagnosis diagnosed(const UnloadedSpec& spec, Noise& noise) {
  AccuracyDiagnosis result = accuracy::diagnoseAccuracy(unloadedCampaign(spec, noise));
  EXPECT_TRUE(result.usable);
  return result;
}

/// "frame_error|tracker_drift (robot), unknown": the verdict in a line.
std::string inWords(const AccuracyDiagnosis& result) {
  std::string words;
  for (const accuracy::AccuracyEntry& entry : result.verdict) {
    std::string ids;
    for (const UnloadedEffect effect : entry.effects) ids += (ids.empty() ? "" : "|") + std::string(idOf(effect));
    words += (words.empty() ? "" : ", ") + (ids.empty() ? std::string("unknown") : ids);
    if (!entry.detail.empty()) words += " (" + entry.detail + ")";
  }
  return words.empty() ? "none" : words;
}

/// The part of the verdict's first class that was fitted first.
calibration::EffectPart firstPart(const AccuracyDiagnosis& result) {
  if (result.classes.empty() || result.classes.front().parts.empty()) return {};
  return result.classes.front().parts.front();
}

/// Joint 1 off by its gear's own order: some 90 um at the reflectors, of both signs.
JointVector byGear(const JointVector& q) { return 60e-6 * std::sin(20.75 * q[0] + 0.4) * JointVector::Unit(6, 0); }

Eigen::Vector3d reflectorShift(int posture, std::size_t target) {
  return target == 1 && posture >= 36 ? Eigen::Vector3d(0.2e-3, 0.0, -0.15e-3) : Eigen::Vector3d::Zero();
}

TEST(DiagnoseAccuracy, ACleanDayIsNone) {
  for (const std::uint64_t seed : {11u, 12u, 13u}) {
    SCOPED_TRACE(seed);
    Noise noise(seed);
    const AccuracyDiagnosis result = diagnosed(machine(noise, 60), noise);
    EXPECT_EQ(inWords(result), "none");
    EXPECT_GT(result.gap.nominal, 5.0 * result.gap.before);
    // 33 parameters of 270 equations: held out a tenth more than the noise, and as much again by luck.
    EXPECT_NEAR(result.gap.before, 20e-6, 5e-6);
    EXPECT_NEAR(result.gap.noise, 20e-6, 1e-9);
  }
}

TEST(DiagnoseAccuracy, AGearsOrderIsATransmissionErrorOfItsJoint) {
  Noise noise(21);
  UnloadedSpec spec = machine(noise, 100);
  spec.joint_errors = &byGear;
  const AccuracyDiagnosis result = diagnosed(spec, noise);
  EXPECT_EQ(inWords(result), "transmission_error (joint 1)");
  // A third of a turn tells orders apart by three, and its peak by a tenth of that; orders are sought by quarters.
  EXPECT_NEAR(firstPart(result).order.value_or(0.0), 20.75, 0.5);
}

/// Of one reflector there are hardly four equations for each of the geometry's 33 parameters: enough terms of a drift
/// explain whatever half of such a day shows, and must not.
TEST(DiagnoseAccuracy, FewReadingsOfOneReflectorAreNotExplainedAway) {
  for (const std::uint64_t seed : {31u, 32u, 33u}) {
    SCOPED_TRACE(seed);
    Noise noise(seed);
    UnloadedSpec spec = machine(noise, 40);
    spec.on_flange.resize(1);
    const AccuracyDiagnosis clean = diagnosed(spec, noise);
    EXPECT_EQ(inWords(clean), "none");
    EXPECT_LT(clean.gap.after, 2.0 * clean.gap.before);
    spec.joint_errors = [](const JointVector& q) -> JointVector {
      return 300e-6 * std::sin(2.0 * q[0] + 0.4) * JointVector::Unit(6, 0);
    };
    const AccuracyDiagnosis waves = diagnosed(spec, noise);
    EXPECT_EQ(inWords(waves), "transmission_error (joint 1)");
    EXPECT_LT(waves.gap.after, waves.gap.before);
  }
}

TEST(DiagnoseAccuracy, AReflectorThatMovedIsNamed) {
  Noise noise(22);
  UnloadedSpec spec = machine(noise, 60);
  spec.target_moved = &reflectorShift;
  const AccuracyDiagnosis result = diagnosed(spec, noise);
  EXPECT_EQ(inWords(result), "target_motion (P11)");
  EXPECT_NEAR(firstPart(result).from.value_or(0.0), 36.0 / 59.0, 2.0 / 59.0);
}

TEST(DiagnoseAccuracy, AScaleThatEntersAtATime) {
  Noise noise(23);
  UnloadedSpec spec = machine(noise, 80);
  spec.scale = [](int posture) { return posture >= 45 ? 1.0 + 60e-6 : 1.0; };
  EXPECT_EQ(inWords(diagnosed(spec, noise)), "scale_error");
}

/// Steel that warms by eight degrees and cools again: what follows the thermometer and not the clock.
TEST(DiagnoseAccuracy, AnArmThatGrowsByTemperature) {
  Noise noise(24);
  UnloadedSpec spec = machine(noise, 80);
  const auto warm = [](int posture) { return 4.0 - 4.0 * std::cos(posture / 79.0 * 3.0 * std::numbers::pi); };
  spec.temperature_c = [warm](int posture) { return 20.0 + warm(posture); };
  spec.arm_at = [warm](const ChainArm& built, int posture) {
    ChainArm arm = built;
    for (Eigen::Isometry3d& one : arm.to_joint) one.translation() *= 1.0 + 12e-6 * warm(posture);
    return arm;
  };
  EXPECT_EQ(inWords(diagnosed(spec, noise)), "thermal_growth");
}

TEST(DiagnoseAccuracy, AnglesReadBeforeTheArmStood) {
  Noise noise(25);
  UnloadedSpec spec = machine(noise, 60);
  spec.still_to_go = 1e-4;
  EXPECT_EQ(inWords(diagnosed(spec, noise)), "read_back_error");
}

TEST(DiagnoseAccuracy, AStationThatJumped) {
  Noise noise(26);
  UnloadedSpec spec = machine(noise, 60);
  spec.station_moved = [](int posture) {
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    if (posture < 25) return moved;
    moved.translation() = Eigen::Vector3d(0.15e-3, -0.1e-3, 0.05e-3);
    moved.rotate(Eigen::AngleAxisd(30e-6, Eigen::Vector3d(0.3, 0.2, 0.93).normalized()));
    return moved;
  };
  EXPECT_EQ(inWords(diagnosed(spec, noise)), "frame_error");
}

TEST(DiagnoseAccuracy, AStationThatWanders) {
  Noise noise(36);
  UnloadedSpec spec = machine(noise, 80);
  spec.station_moved = [](int posture) {
    const double time = posture / 79.0;
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.translation() = time * time * Eigen::Vector3d(0.3e-3, -0.2e-3, 0.1e-3);
    moved.rotate(Eigen::AngleAxisd(50e-6 * std::sin(4.0 * time), Eigen::Vector3d::UnitZ()));
    return moved;
  };
  EXPECT_EQ(inWords(diagnosed(spec, noise)), "tracker_drift");
}

/// Six nests on the floor, read six times over the day through the station of `spec`, where it then stood.
void addNests(const UnloadedSpec& spec, Noise& noise, campaign::Campaign& campaign) {
  campaign::Nests& nests = campaign.nests.emplace();
  nests.file = "nests.csv";
  std::vector<Eigen::Vector3d> floor;
  for (int n = 0; n < 6; ++n) {
    campaign.nest_ids.push_back("N" + std::to_string(n + 1));
    floor.emplace_back(3.0 * std::cos(1.1 * n), 3.0 * std::sin(1.1 * n) - 1.0, 0.3 * n - 0.6);
  }
  for (int round = 0; round < 6; ++round) {
    const int posture = round * (spec.postures - 1) / 5;
    for (std::size_t n = 0; n < floor.size(); ++n) {
      campaign::NestReading reading;
      reading.nest = static_cast<int>(n);
      reading.time_s = 30.0 * posture + 1.0 + static_cast<double>(n);
      reading.point = spec.station_moved(posture) * floor[n] + spec.noise * noise.normal3();
      reading.line = nests.rows.size() + 2;
      nests.rows.push_back(reading);
    }
  }
}

// What the station did is the cause that is named, and no part of what is said of the arm.
TEST(DiagnoseAccuracy, AccuracyIsOfReadingsWithTheStationsMotionTakenOff) {
  Noise noise(41);
  UnloadedSpec spec = machine(noise, 60);
  spec.station_moved = [](int posture) {
    return Eigen::Isometry3d(Eigen::Translation3d(posture / 59.0 * Eigen::Vector3d(0.5e-3, -0.4e-3, 0.2e-3)));
  };
  campaign::Campaign campaign = unloadedCampaign(spec, noise);
  addNests(spec, noise, campaign);
  for (campaign::LoadingReading& reading : campaign.loading->rows) reading.time_s = 30.0 * reading.pose;
  const AccuracyDiagnosis result = accuracy::diagnoseAccuracy(campaign);
  ASSERT_TRUE(result.usable);
  ASSERT_TRUE(result.as_read.has_value());
  EXPECT_EQ(inWords(result), "tracker_drift");
  const double as_read = result.as_read->geometry().held_out.rms;
  EXPECT_GT(as_read, 100e-6);
  EXPECT_NEAR(result.gap.before, as_read / std::sqrt(3.0), 1e-12);
  EXPECT_LT(result.calibration.geometry().held_out.rms, 60e-6);  // 35 um of noise, what 60 postures leave, the nests'
  // Of the readings as they are used, as `calibrate` has them.
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(campaign);
  EXPECT_NEAR(result.calibration.geometry().held_out.rms,
              calibration::calibrate(prepared.campaign, accuracy::kDiagnosisFolds).geometry().held_out.rms, 2e-6);
}

TEST(DiagnoseAccuracy, AWristThatTurnsAlong) {
  Noise noise(37);
  UnloadedSpec spec = machine(noise, 80);
  spec.joint_errors = [](const JointVector& q) { return JointVector(3e-4 * q[3] * JointVector::Unit(6, 4)); };
  EXPECT_EQ(inWords(diagnosed(spec, noise)), "ratio_error (joints 4 and 5)");
}

/// A ratio over the angles at which a joint stands may be drawn by slow waves; it is the ratio that is found, and what
/// the gears do besides.
TEST(DiagnoseAccuracy, ARatioIsNotDrawnByWaves) {
  Noise noise(36);
  UnloadedSpec spec = machine(noise, 200);
  spec.joint_errors = [](const JointVector& q) {
    return JointVector(1.5e-3 * q[1] * JointVector::Unit(6, 1) +
                       1.2e-4 * std::sin(13.25 * q[1] + 0.3) * JointVector::Unit(6, 1) + byGear(q));
  };
  const AccuracyDiagnosis result = diagnosed(spec, noise);
  const std::string words = inWords(result);
  EXPECT_NE(words.find("ratio_error"), std::string::npos) << words;
  EXPECT_NE(words.find("transmission_error"), std::string::npos) << words;
  EXPECT_EQ(words.find("unknown"), std::string::npos) << words;
}

/// Readings of a real arm that grows by six per mille, quickly at first: with one reflector growth and the station's
/// scale are hard to tell apart on what the real arm does besides, and are said together.
TEST(DiagnoseAccuracy, GrowthInRealReadingsIsNamedWithWhatItLooksLike) {
  const std::filesystem::path folder = std::filesystem::path(STIFFSCOPE_SHARED_DIR) / "real/ur5-unloaded";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "the real days are not here";
  campaign::Campaign day = campaign::readCampaign(folder).campaign;
  const calibration::Calibration nominal = calibration::calibrate(day, {.folds = 2, .fold_size = 1});
  const Eigen::Isometry3d base_from_points = nominal.of(calibration::CalibratedModel::nominal).fit.basePointsMotion();
  const Eigen::Vector3d base = base_from_points.inverse().translation();
  const double poses = static_cast<double>(day.pose_ids.size());
  for (campaign::LoadingReading& reading : day.loading->rows)
    reading.point += 6e-3 * (1.0 - std::exp(-reading.pose / poses / 1.2)) * (reading.point - base);
  const AccuracyDiagnosis result = accuracy::diagnoseAccuracy(day, {.folds = 2, .fold_size = 1});
  const auto named = std::find_if(result.verdict.begin(), result.verdict.end(), [](const auto& entry) {
    return std::find(entry.effects.begin(), entry.effects.end(), UnloadedEffect::thermal_growth) != entry.effects.end();
  });
  ASSERT_NE(named, result.verdict.end()) << inWords(result);
  EXPECT_LE(named->effects.size(), 3u) << inWords(result);
}

/// All joints twist under the own weight, as a spring on axis 2 beside that could look like.
TEST(DiagnoseAccuracy, JointsThatTwistUnderTheOwnWeight) {
  Noise noise(38);
  UnloadedSpec spec = machine(noise, 80);
  spec.joint_errors = [arm = spec.nominal](const JointVector& q) {
    return JointVector(exampleCompliance().cwiseProduct(arm.weightTorque(q)));
  };
  const AccuracyDiagnosis result = diagnosed(spec, noise);
  ASSERT_EQ(result.verdict.size(), 1u) << inWords(result);
  ASSERT_FALSE(result.verdict.front().effects.empty());
  EXPECT_EQ(result.verdict.front().effects.front(), UnloadedEffect::joint_compliance) << inWords(result);
}

// The same machine, whose URDF states no masses: products of compliances and moments explain it.
TEST(DiagnoseAccuracy, WeightsThatNobodyStatesAreSeenAsProducts) {
  Noise noise(38);
  UnloadedSpec spec = machine(noise, 120);
  spec.joint_errors = [arm = spec.nominal](const JointVector& q) {
    return JointVector(exampleCompliance().cwiseProduct(arm.weightTorque(q)));
  };
  spec.nominal.mass.assign(spec.nominal.mass.size(), 0.0);
  const AccuracyDiagnosis result = diagnosed(spec, noise);
  ASSERT_FALSE(result.calibration.day.masses_known);
  ASSERT_FALSE(result.verdict.empty());
  const auto& effects = result.verdict.front().effects;
  EXPECT_NE(std::find(effects.begin(), effects.end(), UnloadedEffect::joint_compliance), effects.end())
      << inWords(result);
  EXPECT_GT(result.gap.before, 3.0 * result.gap.noise);
  EXPECT_LT(result.gap.after, 1.5 * result.gap.noise);
}

TEST(DiagnoseAccuracy, TwoAtOnceAreBothNamed) {
  Noise noise(27);
  UnloadedSpec spec = machine(noise, 100);
  spec.joint_errors = &byGear;
  spec.target_moved = &reflectorShift;
  const std::string words = inWords(diagnosed(spec, noise));
  EXPECT_NE(words.find("transmission_error (joint 1)"), std::string::npos) << words;
  EXPECT_NE(words.find("target_motion (P11)"), std::string::npos) << words;
}

/// Each posture's flange thrown by a motion of its own: no effect of the vocabulary, and far beyond noise.
TEST(DiagnoseAccuracy, WhatNothingExplainsIsUnknownAlone) {
  for (const std::uint64_t seed : {28u, 29u, 30u}) {
    SCOPED_TRACE(seed);
    Noise noise(seed), thrown(1000 + seed);
    UnloadedSpec spec = machine(noise, 60);
    spec.flange_thrown = [&thrown](int) {
      Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
      motion.translation() = 100e-6 * thrown.normal3();
      motion.rotate(Eigen::AngleAxisd(400e-6 * thrown.normal(), thrown.direction()));
      return motion;
    };
    EXPECT_EQ(inWords(diagnosed(spec, noise)), "unknown");
  }
}

TEST(DiagnoseAccuracy, AUrdfOfAnotherArmIsAKinematicError) {
  Noise noise(31);
  UnloadedSpec spec = machine(noise, 60);
  spec.built = spec.nominal.disturbed(noise, 4e-3, 3e-3);
  const AccuracyDiagnosis result = diagnosed(spec, noise);
  EXPECT_EQ(inWords(result), "kinematic_error");
  EXPECT_TRUE(result.geometry_off_nominal);
  EXPECT_GT(result.gap.nominal, result.geometry_limit);
  // Its shrink and share are of the same figures, and the shrink has an interval as any other.
  const accuracy::AccuracyGap& gap = result.gap;
  const accuracy::AccuracyClass& named = result.classes.front();
  EXPECT_NEAR(named.shrink.value, 1.0 - gap.before / gap.nominal, 1e-6);
  EXPECT_LT(named.shrink.low, named.shrink.value - 1e-4);
  EXPECT_GT(named.shrink.high, named.shrink.value + 1e-4);
  const double noise_square = gap.noise * gap.noise, nominal_square = gap.nominal * gap.nominal;
  EXPECT_NEAR(named.explained, (nominal_square - gap.before * gap.before) / (nominal_square - noise_square), 1e-9);
}

TEST(DiagnoseAccuracy, ShrinkIntervalsHoldTheirValues) {
  Noise noise(32);
  UnloadedSpec spec = machine(noise, 60);
  spec.joint_errors = &byGear;
  const AccuracyDiagnosis result = diagnosed(spec, noise);
  ASSERT_FALSE(result.classes.empty());
  std::vector<diagnosis::Shrink> shrinks{result.shrink_together};
  for (const accuracy::AccuracyClass& one : result.classes) shrinks.push_back(one.shrink);
  for (const diagnosis::Shrink& shrink : shrinks) {
    EXPECT_LT(0.0, shrink.low);
    EXPECT_LE(shrink.low, shrink.value);
    EXPECT_LE(shrink.value, shrink.high);
    EXPECT_LE(shrink.high, 1.0);
  }
  // The gap falls as far by fits to each fold's others as the linearised day says, whose folds are the same.
  EXPECT_NEAR(result.shrink_together.value, 1.0 - result.gap.after / result.gap.before, 0.02);
  EXPECT_GT(result.classes.front().explained, 0.9);

  // Without other divisions the gap shrinks as far; its interval is what the postures alone make it.
  calibration::CalibrationOptions alone = accuracy::kDiagnosisFolds;
  alone.divisions = 0;
  Noise again(32);
  UnloadedSpec same = machine(again, 60);
  same.joint_errors = &byGear;
  const AccuracyDiagnosis by_postures = accuracy::diagnoseAccuracy(unloadedCampaign(same, again), alone);
  EXPECT_EQ(by_postures.shrink_together.value, result.shrink_together.value);
  EXPECT_LT(0.0, by_postures.shrink_together.low);
  EXPECT_LT(by_postures.shrink_together.low, by_postures.shrink_together.high);
}

/// Disabled: what starts at a time is held out with the time of the whole day here, and in the gap with the time that
/// the other fold has, which may be some postures off. The two say 0.54 and 0.34.
TEST(DiagnoseAccuracy, TheShrinkOfAStartIsThatOfTheGap) {
  Noise noise(32);
  UnloadedSpec spec = machine(noise, 60);
  spec.target_moved = &reflectorShift;
  const AccuracyDiagnosis result = diagnosed(spec, noise);
  EXPECT_NEAR(result.shrink_together.value, 1.0 - result.gap.after / result.gap.before, 0.02);
}

/// Disabled: sizes of a selection that was made once more, with the noise that is left, are taken for parts of the
/// noise that the geometry leaves. They come out too large by the share by which the gap shrinks.
TEST(DiagnoseAccuracy, AnEffectIsNoLargerThanTheGap) {
  Noise noise(25);
  UnloadedSpec spec = machine(noise, 60);
  spec.still_to_go = 1e-4;
  const AccuracyDiagnosis result = diagnosed(spec, noise);
  ASSERT_FALSE(result.classes.empty());
  EXPECT_LT(result.classes.front().size, result.gap.before);
}

/// Disabled: a millimetre from the posture 48 of 60 on. What each fold leaves of it is too little to be found there, so
/// the effect is withdrawn, but what it explained then counts as explained all the same.
TEST(DiagnoseAccuracy, WhatIsWithdrawnIsNotExplained) {
  Noise noise(100);
  UnloadedSpec spec = machine(noise, 60);
  spec.target_moved = [](int posture, std::size_t target) {
    return target == 1 && posture >= 48 ? Eigen::Vector3d(0.8e-3, 0.0, -0.6e-3) : Eigen::Vector3d(0.0, 0.0, 0.0);
  };
  EXPECT_NE(inWords(diagnosed(spec, noise)), "none");
}

TEST(DiagnoseAccuracy, SharesOfPartsOfTheGapAreAllOfIt) {
  Noise noise(33);
  UnloadedSpec spec = machine(noise, 60);
  spec.target_moved = &reflectorShift;
  const AccuracyDiagnosis result = diagnosed(spec, noise);
  for (const auto* tables : {&result.where, &result.where_after}) {
    ASSERT_FALSE(tables->empty());
    for (const diagnosis::WhereTable& table : *tables) {
      if (table.overlaps) continue;
      double shares = 0.0;
      for (const diagnosis::WhereRow& row : table.rows) shares += row.share;
      EXPECT_NEAR(shares, 1.0, 1e-9) << table.by;
    }
  }
  // The reflector that moved has most of what the geometry leaves.
  const auto& reflectors = result.where.front();
  ASSERT_EQ(reflectors.by, "reflector");
  ASSERT_EQ(reflectors.rows.size(), 3u);
  EXPECT_GT(reflectors.rows[1].share, 0.5);
}

/// A hundredth of the readings one to three decimetres off.
TEST(DiagnoseAccuracy, GrossReadingsDoNotChangeTheVerdict) {
  Noise noise(34);
  UnloadedSpec spec = machine(noise, 100);
  spec.joint_errors = &byGear;
  campaign::Campaign day = unloadedCampaign(spec, noise);
  const std::string before = inWords(accuracy::diagnoseAccuracy(day));
  EXPECT_EQ(before, "transmission_error (joint 1)");
  for (const std::size_t row : {17u, 130u, 251u})
    day.loading->rows[row].point += (0.1 + 0.2 * noise.uniform()) * noise.direction();
  const AccuracyDiagnosis after = accuracy::diagnoseAccuracy(day);
  EXPECT_EQ(inWords(after), before);
  EXPECT_EQ(after.calibration.rejected.size(), 3u);
}

/// Twelve postures with far more than noise in them: no effect is asked for, so that none is denied.
TEST(DiagnoseAccuracy, ADayOfFewPosturesSaysThatNoEffectWasAskedFor) {
  Noise noise(42);
  UnloadedSpec spec = machine(noise, 12);
  spec.joint_errors = [](const JointVector& q) { return JointVector(50.0 * byGear(q)); };
  const AccuracyDiagnosis result = diagnosed(spec, noise);
  EXPECT_FALSE(result.effects_asked);
  EXPECT_NE(inWords(result).find("unknown"), std::string::npos) << inWords(result);
  const auto says = [&result](accuracy::RemarkId id) {
    return std::any_of(result.reasons.begin(), result.reasons.end(), [id](const Remark& one) { return one.is(id); });
  };
  EXPECT_TRUE(says(accuracy::RemarkId::effects_not_asked));
  EXPECT_TRUE(says(accuracy::RemarkId::not_looked_into));
  EXPECT_FALSE(says(accuracy::RemarkId::no_effect_passes));
  EXPECT_FALSE(says(accuracy::RemarkId::not_explained));
  ASSERT_EQ(result.next.size(), 1u);
  EXPECT_TRUE(result.next.front().is(accuracy::RemarkId::measure_enough));
  Noise more(42);
  EXPECT_TRUE(diagnosed(machine(more, 20), more).effects_asked);
}

/// `calibrate` and `diagnose` fit one day in one way, with the noise that it was found to have.
TEST(DiagnoseAccuracy, TheCalibrationIsThatOfTheDay) {
  Noise noise(43);
  UnloadedSpec spec = machine(noise, 60);
  spec.joint_errors = &byGear;
  preparation::PreparedCampaign prepared = preparation::prepareCampaign(unloadedCampaign(spec, noise));
  prepared.noise.degrees = 200.0;
  prepared.noise.along_factor = prepared.noise.across_factor = 1.5;
  const calibration::Calibration alone = calibration::calibrate(prepared, accuracy::kDiagnosisFolds);
  const calibration::Calibration diagnosed_with = accuracy::diagnoseAccuracy(prepared).calibration;
  EXPECT_NEAR(alone.noise, 1.5 * 20e-6, 1e-9);
  EXPECT_EQ(alone.noise, diagnosed_with.noise);
  EXPECT_EQ(alone.best().fit.sizes, diagnosed_with.best().fit.sizes);
  EXPECT_EQ(alone.best().fit.covariance, diagnosed_with.best().fit.covariance);
  prepared.noise.degrees = 0.0;  // too few repeats: as declared
  EXPECT_NEAR(calibration::calibrate(prepared, accuracy::kDiagnosisFolds).noise, 20e-6, 1e-9);
}

TEST(DiagnoseAccuracy, ADayWithoutPosturesSaysWhy) {
  Noise noise(35);
  campaign::Campaign day = unloadedCampaign(UnloadedSpec{}, noise);
  day.loading.reset();
  const AccuracyDiagnosis result = accuracy::diagnoseAccuracy(day);
  EXPECT_FALSE(result.usable);
  EXPECT_TRUE(result.unusable_reason.is(calibration::RemarkId::no_unloaded_readings));
}

}  // namespace diagnose_accuracy_test
}  // namespace stiffscope
