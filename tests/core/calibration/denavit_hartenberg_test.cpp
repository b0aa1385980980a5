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

}  // namespace denavit_hartenberg_test
}  // namespace stiffscope
