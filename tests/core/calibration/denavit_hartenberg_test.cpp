#include "core/calibration/denavit_hartenberg.h"

#include <gtest/gtest.h>

#include "core/robot/kinematics.h"
#include "tests/fixtures/chain_arm.h"

namespace stiffscope {
namespace denavit_hartenberg_test {

constexpr double kRounding = 1e-11;  // m: a dozen products of metres

void expectTheSame(const ChainArm& arm, const robot::Robot& nominal, Noise& noise) {
  const calibration::DenavitHartenberg parameters = calibration::denavitHartenberg(arm.robot(), nominal);
  for (int k = 0; k < 20; ++k) {
    const JointVector q = somePosture(noise);
    const Eigen::Isometry3d difference = parameters.flangeAt(q).inverse() * arm.flangeAt(q);
    EXPECT_LT((difference.matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), kRounding);
  }
}

TEST(DenavitHartenberg, MovesTheFlangeAsTheArmDoes) {
  Noise noise(1);
  const ChainArm nominal = exampleChain();
  expectTheSame(nominal, nominal.robot(), noise);
  for (int k = 0; k < 20; ++k) expectTheSame(nominal.disturbed(noise, 1e-3, 3e-3), nominal.robot(), noise);
}

TEST(DenavitHartenberg, TheExampleByHand) {
  const robot::Robot arm = exampleChain().robot();
  const calibration::DenavitHartenberg parameters = calibration::denavitHartenberg(arm, arm);
  // Axis 1 vertical, axis 2 0.41 m beside it across: a right angle. Axes 2 and 3 are parallel, 1.12 m apart.
  EXPECT_FALSE(parameters.links[0].hayati);
  EXPECT_NEAR(std::abs(parameters.links[0].a), 0.41, kRounding);
  EXPECT_NEAR(std::abs(parameters.links[0].alpha), std::numbers::pi / 2.0, kRounding);
  EXPECT_TRUE(parameters.links[1].hayati);
  EXPECT_NEAR(std::abs(parameters.links[1].a), 1.12, kRounding);
  EXPECT_NEAR(parameters.links[1].beta, 0.0, kRounding);
  EXPECT_NEAR(std::abs(parameters.links[3].d), 1.285, kRounding);
}

TEST(DenavitHartenberg, WhatIsRoundingIsNoUncertainty) {
  PerJoint<calibration::LinkParameters> sds(2);
  sds[0].theta = 5e-24, sds[0].alpha = 2e-4, sds[0].a = 1e-4, sds[0].d = 2e-14;
  sds[1].theta = 1e-4, sds[1].alpha = 1e-6, sds[1].a = 5e-9, sds[1].d = 1e-4;
  const PerJoint<calibration::LinkParameters> known = calibration::withoutRounding(sds);
  EXPECT_EQ(known[0].theta, 0.0);
  EXPECT_EQ(known[0].d, 0.0);
  EXPECT_EQ(known[0].beta, 0.0);
  for (const auto number : {&calibration::LinkParameters::alpha, &calibration::LinkParameters::a})
    EXPECT_EQ(known[0].*number, sds[0].*number);
  EXPECT_EQ(known[1].a, 5e-9);
  // A day without noise keeps what it has.
  for (calibration::LinkParameters& link : sds) link.a *= 1e-9, link.d *= 1e-9;
  EXPECT_EQ(calibration::withoutRounding(sds)[1].a, sds[1].a);
}

}  // namespace denavit_hartenberg_test
}  // namespace stiffscope
