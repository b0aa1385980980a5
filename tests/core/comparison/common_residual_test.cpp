#include "core/comparison/compare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fixtures/linear_machine.h"

// Equations of a machine of joint springs; what they leave is put in here.

namespace stiffscope {
namespace common_residual_test {

using comparison::CommonResidual;

constexpr int kPostures = 60;  // of nine coordinates: 534 degrees of freedom, 3 % of a root mean square one sigma

/// One state of the machine, solved by Partial Pose, with numbers of some sd in each coordinate's equation.
identification::Identification stateOf(const LinearMachine& machine, Noise& unmodelled, double misfit, Noise& tracker,
                                       double noise) {
  identification::Identification result(6);
  result.cases = machine.cases;
  identification::MethodResult& solved = result.methods[static_cast<std::size_t>(identification::Method::partial_pose)];
  solved.available = true;
  solved.estimate.identifiable = kAllJoints;
  solved.target_rows = machine.reflectorEquations();
  for (identification::CaseEquations& one : solved.target_rows) {
    for (double& value : one.right) value += misfit * unmodelled.normal() + noise * tracker.normal();
  }
  result.noise.emplace().per_coordinate = noise;
  return result;
}

/// Two states whose misfits are of these seeds.
CommonResidual compared(std::uint64_t before_seed, std::uint64_t after_seed, double misfit, double noise) {
  const LinearMachine machine(kPostures);
  campaign::Campaign campaign;
  for (const char* id : {"P10", "P11", "P12"}) campaign.targets.push_back({id, std::nullopt});
  comparison::MatchedPostures matched;
  for (std::size_t i = 0; i < kPostures; ++i) matched.pairs.push_back({std::to_string(i), i, i});
  Noise before(before_seed), after(after_seed), tracker(77);
  const identification::Identification first = stateOf(machine, before, misfit, tracker, noise),
                                       second = stateOf(machine, after, misfit, tracker, noise);
  return comparison::commonResidual(campaign, first, campaign, second, matched);
}

// 60 um that recur and 20 um that do not: each state leaves their root sum of squares, the difference the noise of
// both.
TEST(CommonResidual, AMisfitThatRecursIsSeen) {
  const CommonResidual found = compared(5, 5, 60e-6, 20e-6);
  ASSERT_TRUE(found.available);
  const double each = std::hypot(60e-6, 20e-6), difference = std::sqrt(2.0) * 20e-6;
  EXPECT_NEAR(found.before, each, 0.12 * each);
  EXPECT_NEAR(found.after, each, 0.12 * each);
  EXPECT_NEAR(found.of_difference, difference, 0.12 * difference);
  EXPECT_NEAR(found.correlation, 0.9, 0.04);  // 60^2 / (60^2 + 20^2)
  EXPECT_LT(found.recurs_p, 1e-6);
  EXPECT_FALSE(found.isNoise());
  EXPECT_FALSE(found.differenceAboveNoise());
}

TEST(CommonResidual, NoiseIsNoise) {
  const CommonResidual found = compared(5, 6, 0.0, 20e-6);
  EXPECT_NEAR(found.before, 20e-6, 0.12 * 20e-6);
  EXPECT_NEAR(found.correlation, 0.0, 0.15);
  EXPECT_GT(found.recurs_p, 0.01);
  EXPECT_TRUE(found.isNoise());
}

// A misfit of each state alone is nothing in common, and no noise.
TEST(CommonResidual, WhatOneStateAloneLeavesIsInTheDifference) {
  const CommonResidual found = compared(5, 6, 200e-6, 20e-6);
  EXPECT_NEAR(found.correlation, 0.0, 0.15);
  EXPECT_TRUE(found.differenceAboveNoise());
  EXPECT_FALSE(found.isNoise());
}

TEST(CommonResidual, WithoutCommonPosturesTheNoiseAloneDecides) {
  const LinearMachine machine(kPostures);
  Noise seed(5), tracker(8);
  const identification::Identification one = stateOf(machine, seed, 0.0, tracker, 20e-6);
  const CommonResidual found = comparison::commonResidual({}, one, {}, one, {});
  EXPECT_TRUE(std::isnan(found.recurs_p));
  EXPECT_TRUE(found.isNoise());
  EXPECT_FALSE(found.differenceAboveNoise());
  EXPECT_FALSE(comparison::commonResidual({}, {}, {}, one, {}).available);
}

}  // namespace common_residual_test
}  // namespace stiffscope
