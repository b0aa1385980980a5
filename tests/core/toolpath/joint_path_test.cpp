#include "core/toolpath/compensate_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/compensation/remarks.h"
#include "core/robot/read_urdf.h"
#include "core/toolpath/remarks.h"
#include "tests/fixtures/chain_arm.h"

namespace stiffscope {
namespace joint_path_test {

using Eigen::Vector3d;

struct SampleArm {
  robot::Robot arm = robot::readUrdf(STIFFSCOPE_SOURCE_DIR "/samples/m900ib700.urdf", "base_link", "tool0");
  Eigen::Isometry3d tool = Eigen::Isometry3d::Identity();

  SampleArm() {
    tool.translation() << 0.12, 0.0, 0.3;
    tool.linear() = robot::rotationFromRpy({0.0, radians(45), 0.0});
  }

  Eigen::Isometry3d toolAt(const JointVector& q) const { return robot::flangeAt(arm, robot::postureAt(arm, q)) * tool; }
};

/// The tool moved in a circle about a point aside of where `q` holds it, keeping its direction.
std::vector<Eigen::Isometry3d> circle(const SampleArm& sample, const JointVector& q, double radius, int poses) {
  const Eigen::Isometry3d first = sample.toolAt(q);
  std::vector<Eigen::Isometry3d> path;
  for (int k = 0; k < poses; ++k) {
    const double angle = 2.0 * EIGEN_PI * k / poses;
    path.push_back(first);
    path.back().translation() += radius * Vector3d(std::cos(angle) - 1.0, std::sin(angle), 0.0);
  }
  return path;
}

double longestStep(const toolpath::JointPath& path) {
  double longest = 0.0;
  for (std::size_t i = 1; i < path.poses.size(); ++i)
    longest = std::max(longest, (path.poses[i].q - path.poses[i - 1].q).cwiseAbs().maxCoeff());
  return longest;
}

TEST(JointPath, StaysOnTheBranchOfTheStart) {
  const SampleArm sample;
  const JointVector q = degrees(15, 10, -15, 40, 70, -20);
  const auto poses = circle(sample, q, 0.2, 60);
  toolpath::JointPathOptions options;
  options.start = q;
  const toolpath::JointPath path = toolpath::jointPath(sample.arm, poses, sample.tool, false, options);
  ASSERT_EQ(path.poses.size(), poses.size());
  EXPECT_LT((path.poses[0].q - q).cwiseAbs().maxCoeff(), 1e-8);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_TRUE(path.poses[i].reason.empty());
    const Eigen::Isometry3d held = sample.toolAt(path.poses[i].q);
    EXPECT_LT((held.translation() - poses[i].translation()).norm(), 1e-9);
    EXPECT_LT((held.linear() - poses[i].linear()).norm(), 1e-9);
  }
  // Steps of 21 mm, a metre and more from every axis but those of the wrist, half a metre away.
  EXPECT_LT(longestStep(path), 0.1);
  // Round once, and back at the start.
  EXPECT_LT((path.poses.back().q - q).cwiseAbs().maxCoeff(), 0.1);
}

TEST(JointPath, WithoutAStartTheBranchOfLeastCostIsTaken) {
  const SampleArm sample;
  const auto poses = circle(sample, degrees(15, 10, -15, 40, 70, -20), 0.2, 30);
  const toolpath::JointPath path = toolpath::jointPath(sample.arm, poses, sample.tool, false, {});
  EXPECT_GE(path.branches, 2u);
  for (const toolpath::JointPathPose& pose : path.poses) {
    EXPECT_TRUE(pose.reason.empty());
    EXPECT_GT(pose.limit_margin, 0.0);
    EXPECT_GT(pose.conditioning, 0.01);
  }
  EXPECT_LT(longestStep(path), 0.2);
}

// The turn about the tool's axis leaves position and axis where they are, and is used: the worst posture of the path is
// farther from limits and singularities than any fixed turn of the same start leaves it.
TEST(JointPath, TheFreeTurnStaysAwayFromLimits) {
  SampleArm sample;
  const JointVector q = degrees(15, 10, -15, 40, 70, -20);
  const auto poses = circle(sample, q, 0.25, 60);
  toolpath::JointPathOptions options;
  options.start = q;
  const toolpath::JointPath fixed = toolpath::jointPath(sample.arm, poses, sample.tool, false, options);
  double lowest = 1e9;
  for (const toolpath::JointPathPose& pose : fixed.poses) lowest = std::min(lowest, pose.q[4]);
  // Joint 5 may just not go where the fixed turn needs it.
  sample.arm.limits[4].lower = lowest + radians(0.5);
  const auto outside = [&](const toolpath::JointPath& path) {
    return std::count_if(path.poses.begin(), path.poses.end(),
                         [](const auto& pose) { return pose.limit_margin < 0.0; });
  };
  EXPECT_GT(outside(toolpath::jointPath(sample.arm, poses, sample.tool, false, options)), 0);
  const toolpath::JointPath free = toolpath::jointPath(sample.arm, poses, sample.tool, true, options);
  EXPECT_EQ(outside(free), 0);
  EXPECT_LT(longestStep(free), 0.2);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Isometry3d held = sample.toolAt(free.poses[i].q);
    EXPECT_LT((held.translation() - poses[i].translation()).norm(), 1e-9);
    EXPECT_LT((held.linear().col(2) - poses[i].linear().col(2)).norm(), 1e-9);
    if (i == 0) continue;
    const double step = (poses[i].translation() - poses[i - 1].translation()).norm();
    EXPECT_LE(std::abs(free.poses[i].turn - free.poses[i - 1].turn), options.turn_per_metre * step + 1e-12);
  }
}

TEST(JointPath, WhatIsOutOfReachIsNamedAndTheRestGoesOn) {
  const SampleArm sample;
  const JointVector q = degrees(15, 10, -15, 40, 70, -20);
  auto poses = circle(sample, q, 0.05, 12);
  poses[5].translation().x() += 5.0;
  toolpath::JointPathOptions options;
  options.start = q;
  const toolpath::JointPath path = toolpath::jointPath(sample.arm, poses, sample.tool, false, options);
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(path.poses[i].reason.empty(), i != 5) << i;
  EXPECT_TRUE(path.poses[5].reason.is(toolpath::RemarkId::not_reached));
  EXPECT_FALSE(path.poses[5].q.allFinite());
}

// Past the wrist's singularity, joint 4 has to turn by nearly half a turn within a few millimetres.
TEST(JointPath, AJumpAtASingularityIsNamed) {
  SampleArm sample;
  sample.tool = Eigen::Isometry3d::Identity();
  const JointVector q = degrees(0, 10, -10, 0.3, 12, 0);
  const Eigen::Isometry3d first = sample.toolAt(q);
  const robot::ArmAxes axes = robot::axesAt(sample.arm, robot::postureAt(sample.arm, q));
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k <= 24; ++k) {
    // The flange turned about axis 5 where it stands: through the straight wrist, past it by 0.06 deg.
    const Eigen::AngleAxisd turn(radians(-1.0 * k), axes[4].direction);
    Eigen::Isometry3d pose = first;
    pose.linear() = turn * first.linear();
    poses.push_back(pose);
  }
  toolpath::JointPathOptions options;
  options.start = q;
  const toolpath::JointPath path = toolpath::jointPath(sample.arm, poses, sample.tool, false, options);
  const bool named = std::any_of(path.poses.begin(), path.poses.end(), [](const auto& pose) {
    return pose.reason.is(toolpath::RemarkId::leaves_branch) || pose.conditioning < 0.01;
  });
  EXPECT_TRUE(named);
}

TEST(JointPath, WholeTurnsAreChosenForThePath) {
  SampleArm sample;
  const JointVector q = degrees(15, 10, -15, 40, 70, 100);
  const auto poses = circle(sample, q, 0.1, 12);
  // Joint 6 may only stand between -300 and -200 deg.
  sample.arm.limits[5] = {radians(-300), radians(-200)};
  toolpath::JointPathOptions options;
  options.seeds = {q};
  const toolpath::JointPath path = toolpath::jointPath(sample.arm, poses, sample.tool, false, options);
  for (const toolpath::JointPathPose& pose : path.poses) {
    EXPECT_GE(pose.q[5], sample.arm.limits[5].lower);
    EXPECT_LE(pose.q[5], sample.arm.limits[5].upper);
  }
}

}  // namespace joint_path_test
}  // namespace stiffscope
