#include "core/robot/inverse_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/robot/read_urdf.h"
#include "tests/fixtures/chain_arm.h"

namespace stiffscope {
namespace inverse_kinematics_test {

using robot::Robot;

const std::string kSources = STIFFSCOPE_SOURCE_DIR;
const std::array<std::string, 3> kArms{kSources + "/samples/m900ib700.urdf", kSources + "/tests/data/rotated_arm.urdf",
                                       kSources + "/tests/data/plain_arm.urdf"};

Eigen::Isometry3d someTool() {
  Eigen::Isometry3d tool = Eigen::Isometry3d::Identity();
  tool.translation() << 0.05, -0.02, 0.21;
  tool.linear() = robot::rotationFromRpy({0.2, -0.4, 0.9});
  return tool;
}

JointVector drawn(std::mt19937_64& random, double reach, int joints = 6) {
  std::uniform_real_distribution<double> angle(-reach, reach);
  return JointVector::NullaryExpr(joints, [&] { return angle(random); });
}

Eigen::Isometry3d toolAt(const Robot& arm, const JointVector& q) {
  return robot::flangeAt(arm, robot::postureAt(arm, q)) * someTool();
}

// Newton's steps end at 1e-10 m and rad.
TEST(InverseKinematics, BringsBackJointsNearby) {
  for (const std::string& file : kArms) {
    const Robot arm = robot::readUrdf(file, "base_link", "tool0");
    std::mt19937_64 random(3);
    for (int k = 0; k < 100; ++k) {
      const JointVector q = drawn(random, 2.0), start = q + drawn(random, 0.01);
      const Eigen::Isometry3d pose = toolAt(arm, q);
      if (robot::conditioningAt(robot::axesAt(arm, robot::postureAt(arm, q)), pose.translation()) < 0.02) continue;
      const robot::InverseKinematics found = robot::inverseKinematics(arm, pose, someTool(), start);
      ASSERT_TRUE(found.reached) << file << " " << k << " " << found.missed;
      // A singular value of J of 0.02 lets joints stray by fifty times the pose's 1e-10, and J's largest are of some m.
      EXPECT_LT((found.q - q).cwiseAbs().maxCoeff(), 1e-7) << file << " " << k;
    }
  }
}

TEST(InverseKinematics, OutOfReachSaysByHowMuch) {
  const Robot arm = robot::readUrdf(kArms[0], "base_link", "tool0");
  Eigen::Isometry3d far = toolAt(arm, degrees(10, 20, -10, 30, 50, 10));
  far.translation() = Eigen::Vector3d(10.0, 0.0, 1.0);
  const robot::InverseKinematics found = robot::inverseKinematics(arm, far, someTool(), degrees(0, 20, -10, 0, 50, 0));
  EXPECT_FALSE(found.reached);
  EXPECT_GT(found.missed, 4.0);  // the arm is some four metres long
}

/// Branches of a posture away from singularities.
std::vector<JointVector> branchesOf(const Robot& arm, const Eigen::Isometry3d& pose, int starts) {
  std::mt19937_64 random(5);
  std::vector<JointVector> seeds;
  for (int k = 0; k < starts; ++k) seeds.push_back(drawn(random, 3.1));
  return robot::inverseKinematicsBranches(arm, pose, someTool(), seeds);
}

// An arm whose last three axes meet has up to eight: shoulder, elbow, wrist.
TEST(InverseKinematics, FindsTheEightBranchesOfASphericalWrist) {
  const Robot arm = robot::readUrdf(kArms[0], "base_link", "tool0");
  const Eigen::Isometry3d pose = toolAt(arm, degrees(10, -30, 10, 40, 60, -20));
  const std::vector<JointVector> branches = branchesOf(arm, pose, 400);
  EXPECT_GE(branches.size(), 4u);
  EXPECT_LE(branches.size(), 8u);
  EXPECT_EQ(branches.size() % 2, 0u);  // each has the wrist turned over
  for (const JointVector& q : branches) {
    const Eigen::Isometry3d held = toolAt(arm, q);
    EXPECT_LT((held.translation() - pose.translation()).norm(), 1e-9);
    EXPECT_LT((held.linear() - pose.linear()).norm(), 1e-9);
    EXPECT_LE((q - robot::withinTurns(arm, q)).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(InverseKinematics, TurnsAreTakenNearTheMiddleOfTheLimits) {
  Robot arm = robot::readUrdf(kArms[0], "base_link", "tool0");
  arm.limits[5] = {1.0, 9.0};
  arm.limits[3] = {-INFINITY, INFINITY};
  const JointVector moved = robot::withinTurns(arm, degrees(0, 0, 0, 350, 0, -90));
  EXPECT_NEAR(moved[5], -0.5 * EIGEN_PI + 2.0 * EIGEN_PI, 1e-12);
  EXPECT_NEAR(moved[3], radians(-10), 1e-12);
}

// A redundant arm has a family of solutions; one of them is as good as another.
TEST(InverseKinematics, OfMoreThanSixJointsHoldsThePose) {
  Noise noise(11);
  std::mt19937_64 random(12);
  for (const ChainArm& chain : {sevenAxisChain(), eightAxisChain()}) {
    const Robot arm = chain.robot();
    for (int k = 0; k < 100; ++k) {
      const JointVector q = somePosture(noise, chain), start = q + drawn(random, 0.1, chain.joints());
      const Eigen::Isometry3d pose = chain.flangeAt(q) * someTool();
      const robot::InverseKinematics found = robot::inverseKinematics(arm, pose, someTool(), start);
      ASSERT_TRUE(found.reached) << chain.joints() << " joints, " << k << ": " << found.missed;
      ASSERT_EQ(found.q.size(), chain.joints());
      const Eigen::Isometry3d held = chain.flangeAt(found.q) * someTool();
      EXPECT_LT((held.translation() - pose.translation()).norm(), 1e-9);
      EXPECT_LT((held.linear() - pose.linear()).norm(), 1e-9);
      EXPECT_LT((found.q - start).norm(), 2.0);  // no whole turns on the way
    }
  }
}

TEST(InverseKinematics, OfFiveJointsReachesWhatItsWristCanHold) {
  const ChainArm chain = fiveAxisChain();
  const Robot arm = chain.robot();
  Noise noise(13);
  std::mt19937_64 random(14);
  for (int k = 0; k < 100; ++k) {
    const JointVector q = somePosture(noise, chain), start = q + drawn(random, 0.01, 5);
    const Eigen::Isometry3d pose = chain.flangeAt(q) * someTool();
    const robot::InverseKinematics found = robot::inverseKinematics(arm, pose, someTool(), start);
    ASSERT_TRUE(found.reached) << k << ": " << found.missed << " m, " << found.turned;
    EXPECT_LT((found.q - q).cwiseAbs().maxCoeff(), 1e-7) << k;  // as of six joints, above

    // Leaning out of the arm's plane, which no joint of the wrist does: the nearest is not there.
    Eigen::Isometry3d leaning = chain.flangeAt(q);
    leaning.linear() =
        Eigen::AngleAxisd(0.1, chain.framesAt(q)[3].linear() * Eigen::Vector3d::UnitX()) * leaning.linear();
    const robot::InverseKinematics nearest = robot::inverseKinematics(arm, leaning, Eigen::Isometry3d::Identity(), q);
    EXPECT_FALSE(nearest.reached) << k;
    EXPECT_GT(nearest.missed + nearest.turned, 0.01) << k;
  }
}

TEST(InverseKinematics, BranchesOfSevenJointsAllHoldThePose) {
  const ChainArm chain = sevenAxisChain();
  const Robot arm = chain.robot();
  Noise noise(15);
  const Eigen::Isometry3d pose = chain.flangeAt(somePosture(noise, chain)) * someTool();
  std::mt19937_64 random(16);
  std::vector<JointVector> seeds;
  for (int k = 0; k < 20; ++k) seeds.push_back(drawn(random, 2.0, 7));
  const std::vector<JointVector> branches = robot::inverseKinematicsBranches(arm, pose, someTool(), seeds);
  ASSERT_FALSE(branches.empty());
  for (const JointVector& q : branches)
    EXPECT_LT(((chain.flangeAt(q) * someTool()).matrix() - pose.matrix()).norm(), 1e-9);
}

// Singular values of a Jacobian of five or seven columns: as many as there are joints, six at the most.
TEST(Conditioning, IsZeroInSingularitiesOfAnyNumberOfJoints) {
  Noise noise(17);
  for (const ChainArm& chain : chainsOfAllSizes()) {
    const Robot arm = chain.robot();
    const auto conditioning = [&](const JointVector& q) {
      return robot::conditioningAt(robot::axesAt(arm, robot::postureAt(arm, q)), chain.flangeAt(q).translation());
    };
    for (int k = 0; k < 20; ++k) EXPECT_GT(conditioning(somePosture(noise, chain)), 1e-3) << chain.joints();
  }
  const ChainArm upright = sevenAxisChain();
  EXPECT_LT(
      robot::conditioningAt(upright.robot().axes_in_base_at_zero, upright.flangeAt(upright.noAngles()).translation()),
      1e-12);
}

}  // namespace inverse_kinematics_test
}  // namespace stiffscope
