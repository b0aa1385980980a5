#include "core/calibration/calibrate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "core/campaign/read_campaign.h"
#include "core/campaign/state_points.h"
#include "core/preparation/prepare.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace calibrate_test {

namespace fs = std::filesystem;
using calibration::CalibratedModel;

bool has(const calibration::ArmFit& fit, calibration::UnloadedEffect effect, const std::string& detail) {
  return std::any_of(fit.parts.begin(), fit.parts.end(), [&](const calibration::EffectPart& part) {
    return part.effect == effect && part.detail == detail;
  });
}

/// Joint 2 errs by a wave of two periods a turn.
UnloadedSpec withWaveOfJoint2(Noise& noise, int postures, double size) {
  UnloadedSpec spec = builtOtherwise(noise);
  spec.postures = postures;
  spec.joint_errors = [size](const JointVector& q) {
    return JointVector(size * std::sin(2.0 * q[1]) * JointVector::Unit(6, 1));
  };
  return spec;
}

TEST(Calibrate, ACleanDayIsGeometryAlone) {
  Noise noise(11);
  const UnloadedSpec spec = builtOtherwise(noise);
  const calibration::Calibration result = calibration::calibrate(unloadedCampaign(spec, noise), {});
  ASSERT_TRUE(result.reason.empty());
  EXPECT_TRUE(result.best().fit.parts.empty());
  EXPECT_TRUE(result.rejected.empty());
  EXPECT_EQ(result.not_identifiable.size(), 6u);  // the choice of frame
  const auto& geometry = result.of(CalibratedModel::geometry);
  // Three coordinates of 20 um each; held out a little more, by 33 parameters of 30 postures.
  EXPECT_NEAR(geometry.fitted.rms, std::sqrt(3.0) * 20e-6, 6e-6);
  EXPECT_GT(geometry.held_out.rms, geometry.fitted.rms);
  EXPECT_LT(geometry.held_out.rms, 1.6 * std::sqrt(3.0) * 20e-6);
  EXPECT_GT(result.of(CalibratedModel::nominal).held_out.rms, 10.0 * geometry.held_out.rms);
}

TEST(Calibrate, FindsAGearsOwnOrder) {
  Noise noise(12);
  UnloadedSpec spec = builtOtherwise(noise);
  spec.postures = 150;
  spec.joint_errors = [](const JointVector& q) {
    JointVector error = JointVector::Zero(6);
    error[1] = 60e-6 * std::sin(17.25 * q[1] + 0.4);
    return error;
  };
  const calibration::Calibration result = calibration::calibrate(unloadedCampaign(spec, noise), {});
  const calibration::ArmFit& fit = result.best().fit;
  ASSERT_TRUE(has(fit, calibration::UnloadedEffect::transmission_error, "joint 2"));
  // Joint 2 turns 70 degrees in these postures: a fifth of a turn tells orders apart by some five, its peak by less.
  EXPECT_NEAR(*fit.parts.front().order, 17.25, 1.0);
  EXPECT_LT(*fit.parts.front().chance, 1e-6);
  EXPECT_LT(result.of(CalibratedModel::effects).held_out.rms, 0.8 * result.of(CalibratedModel::geometry).held_out.rms);
}

/// What lies beyond joint 2 turned about its origin by c times the moment that the bearing carries across its axis: of
/// the weights where the arm has leaned to, not where its angles put them.
Eigen::Isometry3d leanedAtJoint2(const ChainArm& arm, const JointVector& q, double compliance) {
  const auto frames = arm.framesAt(q);
  const Eigen::Vector3d joint = frames[1].translation(), axis = frames[1].linear() * arm.axis[1];
  Eigen::Isometry3d lean = Eigen::Isometry3d::Identity();
  for (int round = 0; round < 20; ++round) {
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (std::size_t b = 1; b < frames.size() - 1; ++b)
      moment += (lean * (frames[b] * arm.centre[b]) - joint).cross(Eigen::Vector3d(0, 0, -9.80665 * arm.mass[b]));
    const Eigen::Vector3d turn = compliance * (moment - axis * axis.dot(moment));
    lean =
        Eigen::Translation3d(joint) * Eigen::AngleAxisd(turn.norm(), turn.normalized()) * Eigen::Translation3d(-joint);
  }
  return lean;
}

// A tonne and a half leans over by a milliradian and pulls the harder for that: by two to three per cent.
TEST(Calibrate, ABearingTiltsByTheWeightThatHasLeaned) {
  Noise noise(31);
  UnloadedSpec spec;
  spec.postures = 150;
  spec.noise = 5e-6;
  for (ChainArm* arm : {&spec.nominal, &spec.built}) arm->centre[1].y() = arm->centre[2].y() = 0.06;
  const double compliance = 2e-6;
  campaign::Campaign campaign = unloadedCampaign(spec, noise);
  for (campaign::LoadingReading& reading : campaign.loading->rows) {
    const JointVector& q = campaign.states->rows[static_cast<std::size_t>(reading.pose)].q;
    reading.point = spec.tracker_from_base *
                    (leanedAtJoint2(spec.built, q, compliance) * (spec.tracker_from_base.inverse() * reading.point));
  }
  const calibration::Calibration result = calibration::calibrate(campaign, {});
  const calibration::ArmFit& fit = result.best().fit;
  ASSERT_FALSE(fit.parts.empty());
  int found = 0;
  Eigen::Index k = 0;
  for (const calibration::EffectPart& part : fit.parts) {
    for (const calibration::EffectTerm& term : part.terms) {
      const double size = fit.sizes[k], sd = fit.sd(static_cast<int>(fit.steps.size() + k));
      ++k;
      if (part.effect != calibration::UnloadedEffect::bearing_tilt || term.name != "joint 2") continue;
      ++found;
      // Beside noise the square of the tilt: a micrometre or two where the reflectors are.
      EXPECT_NEAR(size, compliance, 4.0 * sd + 0.003 * compliance);
      EXPECT_LT(sd, 0.005 * compliance);
    }
  }
  EXPECT_EQ(found, 1);
}

// Two halves of 60 postures leave no piece of the day to four of five inner folds, unless these are cut smaller.
TEST(Calibrate, LargeFoldsFindTheSameEffect) {
  Noise noise(12);
  const UnloadedSpec spec = withWaveOfJoint2(noise, 60, 300e-6);
  const campaign::Campaign day = unloadedCampaign(spec, noise);
  for (const int size : {1, 30}) {
    calibration::CalibrationOptions options;
    options.folds = 2;
    options.fold_size = size;
    EXPECT_FALSE(calibration::calibrate(day, options).best().fit.parts.empty()) << size;
  }
}

// Of four postures the others of a fold do not place the arm: then nothing was held out, which is no error of zero.
TEST(Calibrate, TooFewPosturesHoldNoneOut) {
  Noise noise(12);
  UnloadedSpec spec = builtOtherwise(noise);
  spec.postures = 4;
  const calibration::Calibration result = calibration::calibrate(unloadedCampaign(spec, noise), {});
  for (const calibration::ModelResult& model : result.models) {
    EXPECT_EQ(model.held_out.readings, 0u);
    EXPECT_TRUE(std::isnan(model.held_out.rms));
    EXPECT_GT(model.fitted.readings, 0u);
  }
  ASSERT_FALSE(result.models.empty()) << reports::words(result.reason);
}

// A hundredth of the readings a decimetre off and some beams lost: the same effect is found, and only they are left
// out.
TEST(Calibrate, GrossReadingsHideNoEffect) {
  Noise noise(16);
  const UnloadedSpec spec = withWaveOfJoint2(noise, 150, 60e-6);
  campaign::Campaign campaign = unloadedCampaign(spec, noise);
  for (const std::size_t row : {3u, 101u, 250u, 377u, 440u}) campaign.loading->rows[row].point.x() += 0.1;
  for (const std::size_t row : {400u, 200u, 10u}) campaign.loading->rows.erase(campaign.loading->rows.begin() + row);
  const calibration::Calibration result = calibration::calibrate(campaign, {});
  EXPECT_EQ(result.rejected.size(), 5u);
  // Sine of twice the angle, or what 70 degrees of it cannot tell from that: what is left is noise.
  EXPECT_LT(result.of(CalibratedModel::effects).held_out.rms, 1.4 * std::sqrt(3.0) * 20e-6);
}

/// By a few standard deviations of a reading, and by a hundred: the latter looks like two fifths of gross readings.
TEST(Calibrate, FindsAReflectorThatMoved) {
  for (const double size : {150e-6, 2e-3}) {
    SCOPED_TRACE(size);
    Noise noise(13);
    UnloadedSpec spec = builtOtherwise(noise);
    spec.postures = 100;
    campaign::Campaign campaign = unloadedCampaign(spec, noise);
    for (campaign::LoadingReading& reading : campaign.loading->rows) {
      if (reading.target != 1 || reading.pose < 60) continue;
      const JointVector& q = campaign.states->rows[static_cast<std::size_t>(reading.pose)].q;
      reading.point += spec.tracker_from_base.linear() *
                       (spec.built.flangeAt(q).linear() * (size * Eigen::Vector3d(1.0, 0.0, -0.7)));
    }
    const calibration::Calibration result = calibration::calibrate(campaign, {});
    ASSERT_TRUE(has(result.best().fit, calibration::UnloadedEffect::target_motion, "P11"));
    EXPECT_NEAR(*result.best().fit.parts.front().from, 60.0 / 99.0, 3.0 / 99.0);
    EXPECT_TRUE(result.rejected.empty());
    // In axes of the flange, which at zero are turned against base_link's. To a tenth: 4 um by noise, and three of the
    // forty postures may be on the wrong side of the start.
    const Eigen::Vector3d found = result.best().fit.sizes.head<3>();
    EXPECT_LT((found - size * Eigen::Vector3d(1.0, 0.0, -0.7)).norm(), 0.1 * std::hypot(1.0, 0.7) * size)
        << found.transpose();
    EXPECT_EQ(result.best().fit.parts.front().terms.front().name, "P11 x, in flange axes");
  }
}

// A table may be sorted by anything: a lag of the last move and a reflector that slipped are found by the times.
TEST(Calibrate, RowsInAnyOrderAreReadByTheirTimes) {
  Noise noise(16);
  UnloadedSpec spec = builtOtherwise(noise);
  spec.still_to_go = 1e-4;
  spec.target_moved = [](int posture, std::size_t target) {
    return target == 1 && posture >= 36 ? Eigen::Vector3d(0.2e-3, 0.0, -0.15e-3) : Eigen::Vector3d::Zero();
  };
  const campaign::Campaign in_order = unloadedCampaign(spec, noise);
  campaign::Campaign shuffled = in_order;
  std::mt19937_64 random(3);
  std::shuffle(shuffled.states->rows.begin(), shuffled.states->rows.end(), random);
  std::shuffle(shuffled.loading->rows.begin(), shuffled.loading->rows.end(), random);
  const calibration::UnloadedDay day = calibration::unloadedDay(in_order), other = calibration::unloadedDay(shuffled);
  ASSERT_EQ(day.postures.size(), other.postures.size());
  for (std::size_t i = 0; i < day.postures.size(); ++i) {
    EXPECT_EQ(day.postures[i].pose, other.postures[i].pose);
    EXPECT_EQ(day.postures[i].time, other.postures[i].time);
    EXPECT_EQ(day.postures[i].move, other.postures[i].move);
    EXPECT_EQ(day.postures[i].side, other.postures[i].side);
  }
  const calibration::Calibration result = calibration::calibrate(shuffled, {});
  EXPECT_TRUE(has(result.best().fit, calibration::UnloadedEffect::target_motion, "P11"));
  EXPECT_TRUE(has(result.best().fit, calibration::UnloadedEffect::read_back_error, ""));
  // Without times the order of the rows is all there is.
  for (campaign::State& state : shuffled.states->rows) state.time_s = campaign::kNoTime;
  const calibration::UnloadedDay timeless = calibration::unloadedDay(shuffled);
  EXPECT_FALSE(timeless.times_known);
  EXPECT_EQ(timeless.postures.front().pose, campaign::statePoints(shuffled).front().pose);
}

TEST(Calibrate, FoldsAreBlocksOfTheCampaignsOrder) {
  Noise noise(14);
  const UnloadedSpec spec = builtOtherwise(noise);
  const campaign::Campaign campaign = unloadedCampaign(spec, noise);
  const auto by_one = calibration::calibrate(campaign, {.folds = 2, .fold_size = 1});
  const auto by_ten = calibration::calibrate(campaign, {.folds = 3, .fold_size = 10});
  EXPECT_EQ(by_one.of(CalibratedModel::geometry).fitted.rms, by_ten.of(CalibratedModel::geometry).fitted.rms);
  EXPECT_NE(by_one.of(CalibratedModel::geometry).held_out.rms, by_ten.of(CalibratedModel::geometry).held_out.rms);
  EXPECT_EQ(by_ten.of(CalibratedModel::geometry).held_out.readings, 180u);
}

TEST(Calibrate, SaysWhyNot) {
  Noise noise(15);
  UnloadedSpec spec;
  spec.postures = 3;
  const auto few = calibration::calibrate(unloadedCampaign(spec, noise), {});
  EXPECT_TRUE(few.reason.is(calibration::RemarkId::too_few_readings));
  campaign::Campaign none = unloadedCampaign(spec, noise);
  none.loading.reset();
  EXPECT_TRUE(calibration::calibrate(none, {}).reason.is(calibration::RemarkId::no_unloaded_readings));
}

TEST(Calibrate, SaysThatFewPosturesLetNoEffectBeAskedFor) {
  for (const int postures : {19, 20}) {
    Noise noise(17);
    UnloadedSpec spec = builtOtherwise(noise);
    spec.postures = postures;
    const calibration::Calibration result = calibration::calibrate(unloadedCampaign(spec, noise), {});
    ASSERT_TRUE(result.reason.empty());
    const std::vector<Remark>& notes = result.of(CalibratedModel::effects).notes;
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(reports::words(notes.front()),
              postures < 20 ? "no effect was asked for: 19 postures, which takes 20"
                            : "no effect predicts postures that were held out better than geometry alone");
  }
}

/// Held-out errors of an independent calibration, mm, as the days' own README.md states them, and what the effects by
/// families have to reach on the same folds: a tenth above what they reached when this was written (0.057 and 0.128).
struct Reference {
  const char* day;
  int fold_size;
  double geometry, best, reached;
};

TEST(Calibrate, RealDaysAreBelowTheReference) {
  for (const Reference& reference :
       {Reference{"ur5-unloaded", 1, 0.1123, 0.0726, 0.063}, Reference{"ur10-unloaded", 2, 0.439, 0.309, 0.142}}) {
    const fs::path folder = fs::path(STIFFSCOPE_SHARED_DIR) / "real" / reference.day;
    if (!fs::is_directory(folder)) GTEST_SKIP() << "the real days are not here";
    SCOPED_TRACE(reference.day);
    const preparation::PreparedCampaign day = preparation::prepareCampaign(campaign::readCampaign(folder).campaign);
    const auto result = calibration::calibrate(day.campaign, {.folds = 2, .fold_size = reference.fold_size});
    ASSERT_TRUE(result.reason.empty());
    // Which readings count differs in a few, by the duplicates and by single readings of a posture: half a per cent
    // on the UR10, and as much again for margin.
    EXPECT_LE(result.of(CalibratedModel::geometry).held_out.rms, 1.01 * reference.geometry * 1e-3);
    EXPECT_LT(result.of(CalibratedModel::effects).held_out.rms, reference.best * 1e-3);
    EXPECT_LT(result.of(CalibratedModel::effects).held_out.rms, reference.reached * 1e-3);
  }
}

/// A day whose log has both kinds of angles; the kind that is not right is off by a random 0.01 deg.
campaign::Campaign dayWithBothAngles(calibration::JointAngles right) {
  Noise noise(23);
  UnloadedSpec spec = builtOtherwise(noise);
  spec.postures = 80;
  campaign::Campaign campaign = unloadedCampaign(spec, noise);
  Noise off(24);
  for (campaign::State& state : campaign.states->rows) {
    state.extras().commanded = state.q;
    JointVector& wrong = right == calibration::JointAngles::commanded ? state.q : state.extras().commanded;
    for (int j = 0; j < 6; ++j) wrong[j] += 1.75e-4 * off.normal();
  }
  return campaign;
}

TEST(Calibrate, SaysWhichAnglesFit) {
  for (const auto right : {calibration::JointAngles::reported, calibration::JointAngles::commanded}) {
    const campaign::Campaign campaign = dayWithBothAngles(right);
    const calibration::Calibration by_report = calibration::calibrate(campaign, {});
    ASSERT_TRUE(by_report.angles);
    ASSERT_TRUE(by_report.angles->better);
    EXPECT_EQ(*by_report.angles->better, right);
    const calibration::Calibration by_command =
        calibration::calibrate(campaign, {.angles = calibration::JointAngles::commanded});
    // What is chosen is used, and either way the same comparison is stated.
    EXPECT_DOUBLE_EQ(by_report.best().held_out.rms, by_report.angles->reported.rms);
    EXPECT_DOUBLE_EQ(by_command.best().held_out.rms, by_report.angles->commanded.rms);
    EXPECT_DOUBLE_EQ(by_command.angles->significance, by_report.angles->significance);
    const double good =
        right == calibration::JointAngles::reported ? by_report.best().held_out.rms : by_command.best().held_out.rms;
    EXPECT_LT(good, 1.6 * std::sqrt(3.0) * 20e-6);
  }
}

TEST(Calibrate, AnglesThatDifferByRoundingAreNotJudged) {
  campaign::Campaign campaign = dayWithBothAngles(calibration::JointAngles::reported);
  for (campaign::State& state : campaign.states->rows) {
    for (int j = 0; j < 6; ++j) state.extras().commanded[j] = std::round(state.q[j] / 1e-6) * 1e-6;
  }
  const calibration::Calibration result = calibration::calibrate(campaign, {});
  ASSERT_TRUE(result.angles);
  EXPECT_FALSE(result.angles->better);
  // A posture without its commanded angle: that joint has none.
  campaign.states->rows[7].extras().commanded[2] = std::nan("");
  EXPECT_EQ(calibration::commandedJoints(campaign), (PerJoint<bool>{true, true, false, true, true, true}));
}

}  // namespace calibrate_test
}  // namespace stiffscope
