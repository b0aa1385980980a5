#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/effects/all.h"
#include "core/robot/kinematics.h"
#include "tests/fixtures/chain_arm.h"

namespace stiffscope {
namespace arm_compliance_test {

// Reflectors that move by 0.4 mm under 250 N at the flange's reach; what comes back to no load does not count.
TEST(ArmCompliance, IsWhatReflectorsMoveByOverForceAndReachSquared) {
  const ChainArm chain = exampleChain();
  campaign::Campaign day;
  day.robot = chain.robot();
  day.targets.resize(1);
  EXPECT_EQ(effects::armCompliance(day), 0.0);
  day.states.emplace();
  day.loading.emplace();
  for (int pose = 0; pose < 3; ++pose) {
    const JointVector q = degrees(10.0 * pose, 20, -15 + 5 * pose, 40, 50, -30);
    day.pose_ids.push_back(std::to_string(pose));
    for (int step = 0; step < 3; ++step) {
      Vector6d wrench = Vector6d::Zero();
      if (step == 1) wrench.head<3>() = Eigen::Vector3d(0.0, 150.0, -200.0);
      day.states->rows.emplace_back(pose, step, 0.0, q, wrench);
      campaign::LoadingReading reading;
      reading.pose = pose, reading.step = step;
      for (const double repeat : {-1e-5, 1e-5}) {
        reading.point = Eigen::Vector3d(1.0 + (step == 1 ? 4e-4 : 0.0) + repeat, 2.0, 3.0);
        day.loading->rows.push_back(reading);
      }
    }
  }
  std::vector<double> expected;
  for (std::size_t pose = 0; pose < 3; ++pose) {
    const robot::ArmPosture posture = robot::postureAt(day.robot, day.states->rows[3 * pose].q);
    expected.push_back(4e-4 / (250.0 * robot::flangeAt(day.robot, posture).translation().squaredNorm()));
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_LT(expected[0], 0.99 * expected[1]);
  EXPECT_NEAR(effects::armCompliance(day), expected[1], 1e-9 * expected[1]);
  // The same as differences.
  day.loading.reset();
  day.displacements.emplace();
  for (int pose = 0; pose < 3; ++pose)
    day.displacements->rows.push_back({.pose = pose, .step = 1, .displacement = {0.0, 4e-4, 0.0}});
  EXPECT_NEAR(effects::armCompliance(day), expected[1], 1e-9 * expected[1]);
}

// A bearing of 2e-5 rad/Nm is that of a small gear: too soft for an industrial arm, not for a soft one.
TEST(ArmCompliance, LetsBearingsAndToolsOfSoftArmsBeSofter) {
  const auto most = [](const effects::EffectRecord& record, double compliance) {
    return effects::modelsOf(record, {.joints = 6, .targets = {"P1"}, .compliance = compliance})
        .front()
        .parts[0]
        .most[0];
  };
  EXPECT_EQ(most(effects::bearingTilt(), 0.0), 1e-5);
  EXPECT_EQ(most(effects::bearingTilt(), 5e-7), 1e-5);
  EXPECT_EQ(most(effects::bearingTilt(), 5e-5), 1e-3);
  EXPECT_EQ(most(effects::toolCompliance(), 5e-7), 1e-4);
  EXPECT_EQ(most(effects::toolCompliance(), 5e-5), 2e-3);
}

}  // namespace arm_compliance_test
}  // namespace stiffscope
