#include "core/planning/unloaded_plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/calibration/fitted_day.h"
#include "core/io/input_error.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace unloaded_plan_test {

/// What is known before the day: the arm, its reflectors, where the tracker will stand.
campaign::Campaign beforeTheDay(const UnloadedSpec& spec) {
  campaign::Campaign campaign;
  campaign.name = "before";
  campaign.robot = spec.nominal.robot();
  campaign.tracker = campaign::Tracker{"even", spec.noise, 0.0, spec.noise, 0.0, Eigen::Vector3d::Zero()};
  for (std::size_t t = 0; t < spec.on_flange.size(); ++t)
    campaign.targets.push_back({"P" + std::to_string(10 + t), spec.on_flange[t]});
  return campaign;
}

planning::UnloadedPlanOptions quick(const UnloadedSpec& spec) {
  planning::UnloadedPlanOptions options;
  options.postures = 30;
  options.candidates = 150;
  options.random_sets = 10;
  options.inputs.repeats = 1;
  options.inputs.tracker_in_base = spec.tracker_from_base.inverse().translation();
  return options;
}

TEST(UnloadedPlan, PlannedPosturesTellMoreThanRandomOnes) {
  const UnloadedSpec spec;
  const planning::UnloadedPlanOptions options = quick(spec);
  const campaign::Campaign campaign = beforeTheDay(spec);
  const planning::UnloadedPlan plan = planning::planUnloaded(campaign, options);
  ASSERT_EQ(plan.postures.size(), 30u);
  EXPECT_LT(plan.sight.predicted, 0.95 * plan.random_same.predicted);
  EXPECT_LT(plan.sight.predicted_geometry, plan.random_same.predicted_geometry);
  EXPECT_LT(plan.sight.predicted_geometry, plan.sight.predicted);
  EXPECT_LT(plan.random_double.predicted, plan.random_same.predicted);
  // More postures never tell less, and each tells something.
  for (std::size_t i = 0; i < plan.postures.size(); ++i) {
    EXPECT_GT(plan.postures[i].gain, 0.0);
    if (i > 0) {
      EXPECT_LE(plan.postures[i].predicted, plan.postures[i - 1].predicted * (1.0 + 1e-9));
    }
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GE((plan.postures[i].q - plan.postures[k].q).cwiseAbs().maxCoeff(), options.least_separation);
    EXPECT_EQ(planning::brokenRule(plan.arm, options.rules, robot::postureAt(campaign.robot, plan.postures[i].q),
                                   -Eigen::Vector3d::UnitZ()),
              planning::PostureRule::none);
  }
  // The order tells effects of the order apart at least as well as chance does.
  double planned = 0.0, random = 0.0;
  for (std::size_t e = 0; e < plan.sight.effects.size(); ++e) {
    const std::string& effect = plan.sight.effects[e].effect;
    if (effect != "backlash" && effect != "read_back_error") continue;
    planned += std::log(plan.sight.effects[e].detectable), random += std::log(plan.random_same.effects[e].detectable);
  }
  EXPECT_LT(planned, random);
  const planning::UnloadedPlan again = planning::planUnloaded(campaign, options);
  for (std::size_t i = 0; i < plan.postures.size(); ++i) EXPECT_EQ(plan.postures[i].q, again.postures[i].q);
}

// Days of these postures, measured by the tests' own kinematics: errors of what they predict elsewhere. 25 days of some
// thirty unknowns each leave about 4 % to chance.
TEST(UnloadedPlan, ADayOfItPredictsAsWellAsPromised) {
  Noise noise(5);
  UnloadedSpec spec = builtOtherwise(noise);
  const planning::UnloadedPlan plan = planning::planUnloaded(beforeTheDay(spec), quick(spec));
  spec.postures = static_cast<int>(plan.postures.size());
  campaign::Campaign planned = unloadedCampaign(spec, noise);
  for (std::size_t i = 0; i < plan.postures.size(); ++i) planned.states->rows[i].q = plan.postures[i].q;
  const planning::CandidateDraw elsewhere = planning::drawCandidates(plan.arm, {}, 100, 99);
  double sum = 0.0, count = 0.0;
  for (int day = 0; day < 25; ++day) {
    const calibration::Calibration found = calibration::calibrate(measuredAgain(planned, spec, noise), {});
    ASSERT_TRUE(found.reason.empty());
    const calibration::ArmFit& fit = found.geometry().fit;
    const robot::Robot arm = fit.arm(spec.nominal.robot());
    const std::vector<Eigen::Vector3d> at_zero = fit.targetsAtZero();
    for (const planning::Candidate& one : elsewhere.kept) {
      const Eigen::Isometry3d motion = robot::postureAt(arm, one.q).motion[6];
      for (std::size_t t = 0; t < at_zero.size(); ++t) {
        const Eigen::Vector3d truth = spec.tracker_from_base * (spec.built.flangeAt(one.q) * spec.on_flange[t]);
        sum += (fit.basePointsMotion().inverse() * (motion * at_zero[t]) - truth).squaredNorm();
        ++count;
      }
    }
  }
  EXPECT_NEAR(std::sqrt(sum / count) / plan.sight.predicted_geometry, 1.0, 0.2);
}

TEST(UnloadedPlan, RefusesWhatCannotBePlanned) {
  const UnloadedSpec spec;
  planning::UnloadedPlanOptions options = quick(spec);
  options.candidates = 10;
  EXPECT_THROW(planning::planUnloaded(beforeTheDay(spec), options), io::InputError);
  options = quick(spec);
  options.rules.low[0] = 1.0, options.rules.high[0] = 0.5;
  EXPECT_THROW(planning::planUnloaded(beforeTheDay(spec), options), io::InputError);
}

}  // namespace unloaded_plan_test
}  // namespace stiffscope
