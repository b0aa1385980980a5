#include "core/calibration/arm_fit.h"

#include <gtest/gtest.h>

#include "core/calibration/fitted_day.h"
#include "core/robot/kinematics.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace arm_fit_test {

using frames::ArmParameters;

calibration::ArmFit fitted(const calibration::UnloadedDay& day, const calibration::FitOptions& options = {}) {
  const std::vector<double> all(day.readings(), 1.0);
  const auto place = calibration::placeArm(day, all);
  EXPECT_TRUE(place.has_value());
  return calibration::fitArm(day, *place, {}, options);
}

/// Where a reflector of the flange is predicted by the calibrated arm, in the tracker's frame.
Eigen::Vector3d predicted(const calibration::UnloadedDay& day, const calibration::ArmFit& fit, const JointVector& q,
                          std::size_t target) {
  const Eigen::Isometry3d motion = robot::postureAt(fit.arm(day.arm), q).motion[6];
  return fit.basePointsMotion().inverse() * (motion * fit.targetsAtZero()[target]);
}

TEST(ArmFit, PlacesBaseAndReflectorsOfTheNominalArm) {
  Noise noise(1);
  UnloadedSpec spec;
  spec.noise = 0.0;
  campaign::Campaign campaign = unloadedCampaign(spec, noise);
  campaign.tracker.reset();
  for (const std::size_t targets : {3u, 1u}) {
    std::erase_if(campaign.loading->rows, [&](const auto& row) { return row.target >= static_cast<int>(targets); });
    const calibration::UnloadedDay day = calibration::unloadedDay(campaign);
    const auto place = calibration::placeArm(day, std::vector<double>(day.readings(), 1.0));
    ASSERT_TRUE(place);
    // A start: alternating registration ends within millimetres of where least squares goes on.
    EXPECT_LT((place->base_from_points.translation() - spec.tracker_from_base.inverse().translation()).norm(), 0.05);
  }
}

TEST(ArmFit, PredictsPosturesThatWereNotMeasured) {
  Noise noise(2);
  const UnloadedSpec spec = builtOtherwise(noise);
  const calibration::UnloadedDay day = calibration::unloadedDay(unloadedCampaign(spec, noise));
  const calibration::ArmFit fit = fitted(day);
  ASSERT_TRUE(fit.done);
  // Base 6, reflectors 9, axes 24, less the six of the choice of frame.
  EXPECT_EQ(fit.parameters, 33);
  EXPECT_EQ(fit.held.size(), 6u);
  for (int k = 0; k < 50; ++k) {
    const JointVector q = somePosture(noise);
    for (std::size_t t = 0; t < 3; ++t) {
      const Eigen::Vector3d truth = spec.tracker_from_base * (spec.built.flangeAt(q) * spec.on_flange[t]);
      // 33 parameters of 540 readings of 20 um: 20 um sqrt(33 / 540) per coordinate, five times that and the 3-D.
      EXPECT_LT((predicted(day, fit, q, t) - truth).norm(), 5.0 * std::sqrt(3.0) * 20e-6 * std::sqrt(33.0 / 540.0));
    }
  }
}

// Distances between the reflectors are seen whatever the frame: their intervals hold the truth as often as they say. So
// do those of the axes, once the truth stands in the frame that the fit keeps: it is disturbed in what is free alone.
TEST(ArmFit, IntervalsHoldTheTruth) {
  constexpr int kDays = 500;
  const robot::Robot nominal = exampleChain().robot();
  int inside = 0, all = 0;
  for (int d = 0; d < kDays; ++d) {
    Noise noise(1000 + d);
    UnloadedSpec spec;
    spec.postures = 40;
    campaign::Campaign campaign = unloadedCampaign(spec, noise);
    const calibration::UnloadedDay first = calibration::unloadedDay(campaign);
    static const calibration::ArmFit pattern = fitted(first);
    frames::LoadingGeometry truth;
    truth.arm = nominal;
    Eigen::VectorXd steps = Eigen::VectorXd::Zero(ArmParameters(6).count(3));
    for (int k = 0; k < ArmParameters(6).axes(); ++k) {
      const bool held = std::find(pattern.held.begin(), pattern.held.end(), k) != pattern.held.end();
      if (!held) steps[k] = 0.3e-3 * noise.normal();
    }
    truth = frames::moved(truth, steps, Eigen::Vector3d::Zero());
    for (campaign::LoadingReading& reading : campaign.loading->rows) {
      const JointVector& q = campaign.states->rows[static_cast<std::size_t>(reading.pose)].q;
      // Product of exponentials by hand: turn about each moved axis, the last first.
      Eigen::Vector3d point =
          spec.nominal.flangeAt(JointVector::Zero(6)) * spec.on_flange[static_cast<std::size_t>(reading.target)];
      for (int j = 5; j >= 0; --j) {
        const metrology::Line& axis = truth.arm.axes_in_base_at_zero[static_cast<std::size_t>(j)];
        point = axis.point + Eigen::AngleAxisd(q[j], axis.direction) * (point - axis.point);
      }
      reading.point = spec.tracker_from_base * point + spec.noise * noise.normal3();
    }
    const calibration::UnloadedDay day = calibration::unloadedDay(campaign);
    const calibration::ArmFit fit = fitted(day);
    ASSERT_EQ(fit.held, pattern.held);
    for (int k = 0; k < ArmParameters(6).axes(); ++k) {
      if (fit.sd(k) == 0.0) continue;
      ++all;
      inside += std::abs(fit.steps[k] - steps[k]) < 1.959964 * fit.sd(k) ? 1 : 0;
    }
  }
  const double share = static_cast<double>(inside) / all;
  RecordProperty("share", std::to_string(share));
  EXPECT_GT(share, 0.93);
  EXPECT_LT(share, 0.97);
}

TEST(ArmFit, GrossReadingsCostNothingButTheirRows) {
  Noise noise(4);
  UnloadedSpec spec = builtOtherwise(noise);
  spec.postures = 100;
  campaign::Campaign campaign = unloadedCampaign(spec, noise);
  const calibration::UnloadedDay clean = calibration::unloadedDay(campaign);
  const calibration::ArmFit by_clean = fitted(clean);
  for (const std::size_t row : {7u, 110u, 222u}) campaign.loading->rows[row].point += Eigen::Vector3d(0.2, -0.1, 0.2);
  campaign.loading->rows[50].point += Eigen::Vector3d(1e-3, 0.0, 0.0);
  campaign.loading->rows.erase(campaign.loading->rows.begin() + 150);  // a lost beam
  const calibration::UnloadedDay day = calibration::unloadedDay(campaign);
  const calibration::ArmFit fit = fitted(day);
  EXPECT_EQ(std::count(fit.weights.begin(), fit.weights.end(), 0.0), 4);
  for (int k = 0; k < ArmParameters(6).axes(); ++k)
    EXPECT_LE(std::abs(fit.steps[k] - by_clean.steps[k]), by_clean.sd(k)) << k;
}

// One posture a thousand times tells nothing of the axes.
TEST(ArmFit, HoldsWhatThePosturesDoNotSee) {
  Noise noise(5);
  UnloadedSpec spec = builtOtherwise(noise);
  campaign::Campaign campaign = unloadedCampaign(spec, noise);
  for (campaign::State& state : campaign.states->rows) state.q[3] = 0.3;
  for (campaign::LoadingReading& reading : campaign.loading->rows) {
    const JointVector& q = campaign.states->rows[static_cast<std::size_t>(reading.pose)].q;
    reading.point =
        spec.tracker_from_base * (spec.built.flangeAt(q) * spec.on_flange[static_cast<std::size_t>(reading.target)]) +
        spec.noise * noise.normal3();
  }
  const calibration::UnloadedDay day = calibration::unloadedDay(campaign);
  const calibration::ArmFit fit = fitted(day);
  ASSERT_TRUE(fit.done);
  // Joint 4 never turned: its axis is one with what it carries, four numbers less.
  EXPECT_EQ(fit.held.size(), 10u);
  const std::vector<Eigen::Vector3d> residuals = calibration::residualsOf(day, fit);
  for (const Eigen::Vector3d& residual : residuals) EXPECT_LT(residual.norm(), 150e-6);
}

TEST(ArmFit, OwnWeightBringsTheJointsCompliance) {
  Noise noise(6);
  UnloadedSpec spec = builtOtherwise(noise);
  spec.postures = 200;
  const JointVector compliance = exampleCompliance();
  const ChainArm& heavy = spec.built;
  spec.joint_errors = [&](const JointVector& q) { return JointVector(compliance.cwiseProduct(heavy.weightTorque(q))); };
  const calibration::UnloadedDay day = calibration::unloadedDay(unloadedCampaign(spec, noise));
  ASSERT_TRUE(day.masses_known);
  const auto place = calibration::placeArm(day, std::vector<double>(day.readings(), 1.0));
  const calibration::ArmFit fit = calibration::fitArm(day, *place, calibration::jointCompliances(day), {});
  for (int j = 1; j < 3; ++j) {
    // Four of its standard uncertainties, and a thousandth for the arm whose torque is the nominal one's.
    const double sd = fit.sd(static_cast<int>(fit.steps.size()) + j);
    EXPECT_NEAR(fit.sizes[j], compliance[j], 4.0 * sd + 2e-3 * compliance[j]) << j;
    EXPECT_LT(sd, 0.2 * compliance[j]) << j;
  }
  // Joint 1 carries no weight about its axis: nothing is seen of it.
  EXPECT_NEAR(fit.sizes[0], 0.0, 1e-12);
}

/// A floor softer about one level axis than about the other, which is no axis of base_link: the turn is s (s . M) c
/// with M the moment of all weights about the foot, by the chain's own frames.
TEST(ArmFit, AFloorThatIsSoftAskewNeedsTheCoupling) {
  Noise noise(8);
  UnloadedSpec spec = builtOtherwise(noise);
  spec.postures = 150;
  const double compliance = 20e-9, heading = 1.0;
  const Eigen::Vector3d soft(std::cos(heading), std::sin(heading), 0.0);
  campaign::Campaign campaign = unloadedCampaign(spec, noise);
  for (campaign::LoadingReading& reading : campaign.loading->rows) {
    const auto frames = spec.built.framesAt(campaign.states->rows[static_cast<std::size_t>(reading.pose)].q);
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (std::size_t b = 0; b < 6; ++b)
      moment += (frames[b] * spec.built.centre[b]).cross(Eigen::Vector3d(0, 0, -9.80665 * spec.built.mass[b]));
    const Eigen::AngleAxisd turn(compliance * soft.dot(moment), soft);
    reading.point = spec.tracker_from_base * (turn * (spec.tracker_from_base.inverse() * reading.point));
  }
  const calibration::UnloadedDay day = calibration::unloadedDay(campaign);
  const auto place = calibration::placeArm(day, std::vector<double>(day.readings(), 1.0));
  int coupled = 0;
  for (const calibration::EffectFamily& family : calibration::effectFamilies(day)) {
    if (family.effect != calibration::UnloadedEffect::base_compliance) continue;
    for (const calibration::EffectPart& part : family.parts) EXPECT_TRUE(part.terms.front().positive) << part.detail;
    for (const calibration::EffectPart& whole : family.wholes) {
      if (whole.terms.size() != 3) continue;
      ++coupled;
      ASSERT_FALSE(whole.terms[2].positive);
      const calibration::ArmFit fit = calibration::fitArm(day, *place, {whole}, {});
      const Eigen::Matrix3d full = compliance * soft * soft.transpose();
      const std::array<double, 3> truth{full(0, 0), full(1, 1), full(0, 1)};
      for (int k = 0; k < 3; ++k) {
        const double sd = fit.sd(static_cast<int>(fit.steps.size()) + k);
        EXPECT_NEAR(fit.sizes[k], truth[static_cast<std::size_t>(k)], 4.0 * sd + 0.005 * compliance) << k;
        EXPECT_LT(sd, 0.2 * compliance) << k;
      }
    }
  }
  EXPECT_EQ(coupled, 1);
}

TEST(ArmFit, ANegativeComplianceIsRefused) {
  Noise noise(7);
  UnloadedSpec spec = builtOtherwise(noise);
  const ChainArm& heavy = spec.built;
  spec.joint_errors = [&](const JointVector& q) {
    return JointVector(-0.3e-6 * heavy.weightTorque(q).cwiseProduct(JointVector::Unit(6, 2)));
  };
  const calibration::UnloadedDay day = calibration::unloadedDay(unloadedCampaign(spec, noise));
  const auto place = calibration::placeArm(day, std::vector<double>(day.readings(), 1.0));
  const calibration::ArmFit fit = calibration::fitArm(day, *place, calibration::jointCompliances(day), {});
  EXPECT_TRUE(fit.refused[2]);
  EXPECT_EQ(fit.sizes[2], 0.0);
}

}  // namespace arm_fit_test
}  // namespace stiffscope
