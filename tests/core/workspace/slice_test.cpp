#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include "core/io/input_error.h"
#include "core/workspace/slice.h"
#include "core/workspace/workspace_stiffness.h"
#include "tests/fixtures/known_arm.h"

namespace stiffscope {
namespace slice_test {

struct SlicedArm : KnownArm {
  compensation::Certainty certainty{{}, compensation::IdentifiedRange(6)};
  std::vector<workspace::NamedPosture> postures{{"a", degrees(20, 10, -20, 50, 60, -30)},
                                                {"b", degrees(10, 0, -10, 40, 60, -20)},
                                                {"c", degrees(-40, 30, -30, 0, 50, 0)}};

  SlicedArm() {
    certainty.draws = compensation::springDraws(estimate, estimate.covariance);
    geometry.compliance = estimate.compliance;
    certainty.range.force = 1500.0;
    certainty.range.moment = 1e9;
    certainty.range.torque.setConstant(1e9);
    certainty.range.low.setConstant(-3.2);
    certainty.range.high.setConstant(3.2);
  }
  workspace::DeflectingArm arm() const {
    return {campaign, geometry, estimate, Eigen::Vector3d(0.0, 0.0, 0.1), nullptr, &certainty};
  }
};

TEST(ContinuedAngles, BringsTheFlangeThereOnTheSameBranch) {
  const SlicedArm day;
  Noise noise(4);
  int reached = 0;
  for (int i = 0; i < 50; ++i) {
    const JointVector start = somePosture(noise);
    JointVector moved = start;
    for (double& one : moved) one += 0.05 * noise.normal();
    const Eigen::Isometry3d wanted = day.lab.actual.flangeAt(moved);
    const auto found = workspace::continuedAngles(day.geometry.arm, wanted, Eigen::Vector3d::Zero(), start, 0.01, 0.0);
    if (!found) continue;
    ++reached;
    EXPECT_LT((day.lab.actual.flangeAt(*found).matrix() - wanted.matrix()).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((*found - moved).cwiseAbs().maxCoeff(), 1e-6);  // condition numbers of a hundred
  }
  EXPECT_EQ(reached, 50);
}

TEST(ContinuedAngles, EndsAtTheLimitsAndWhereTheArmDoesNotReach) {
  SlicedArm day;
  const JointVector start = day.postures[0].q;
  Eigen::Isometry3d far = day.lab.actual.flangeAt(start);
  far.pretranslate(Eigen::Vector3d(3.0, 0.0, 0.0));
  EXPECT_FALSE(workspace::continuedAngles(day.geometry.arm, far, Eigen::Vector3d::Zero(), start, 0.01, 0.0));
  JointVector moved = start;
  moved[1] += 0.1;
  const Eigen::Isometry3d wanted = day.lab.actual.flangeAt(moved);
  EXPECT_TRUE(workspace::continuedAngles(day.geometry.arm, wanted, Eigen::Vector3d::Zero(), start, 0.01, 0.0));
  EXPECT_FALSE(workspace::continuedAngles(day.geometry.arm, wanted, Eigen::Vector3d::Zero(), start, 0.9,
                                          0.0));  // no posture is so far from singular
  day.geometry.arm.limits[1].upper = start[1] + 0.05;
  EXPECT_FALSE(workspace::continuedAngles(day.geometry.arm, wanted, Eigen::Vector3d::Zero(), start, 0.01, 0.0));
}

TEST(StiffnessSlice, HoldsPlaneAndOrientation) {
  const SlicedArm day;
  const workspace::StiffnessSlice slice = workspace::stiffnessSlice(day.arm(), day.postures, {"a", 0.25});
  EXPECT_EQ(slice.pose, "a");
  ASSERT_GT(slice.places.size(), 20u);
  const Eigen::Matrix3d orientation = day.lab.actual.flangeAt(day.postures[0].q).linear();
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(slice.outward);
  for (const workspace::SlicePlace& place : slice.places) {
    const Eigen::Isometry3d flange = day.lab.actual.flangeAt(place.at.q);
    const Eigen::Vector3d tcp = flange * Eigen::Vector3d(0.0, 0.0, 0.1);
    EXPECT_LT((flange.linear() - orientation).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_NEAR(tcp.dot(across), 0.0, 1e-9);
    EXPECT_NEAR(tcp.dot(slice.outward), place.radius, 1e-9);
    EXPECT_NEAR(tcp.z(), place.height, 1e-9);
    EXPECT_NEAR(std::remainder(place.height, 0.25), 0.0, 1e-12);
  }
}

TEST(StiffnessSlice, WithoutANameTheMiddlePostureIsTaken) {
  const SlicedArm day;
  EXPECT_EQ(workspace::middlePosture(day.postures).pose, "b");
  const workspace::StiffnessSlice slice = workspace::stiffnessSlice(day.arm(), day.postures, {});
  EXPECT_EQ(slice.pose, "b");
  EXPECT_DOUBLE_EQ(slice.spacing, 0.2);  // a reach of 2.4 m or more: the number of 1-2-5 below a twelfth of it
}

TEST(StiffnessSlice, RefusesUnknownPosturesAndTooFineGrids) {
  const SlicedArm day;
  const auto message = [&](const workspace::SliceOptions& options) {
    try {
      workspace::stiffnessSlice(day.arm(), day.postures, options);
    } catch (const io::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message({"x", 0.2}), "--slice: 'x': expected a posture that identifies");
  EXPECT_EQ(message({"a", 0.2, 0.01, 10}), "--spacing: '200': expected a spacing with at most 10 places");
}

// Far from the arm's axes a force has longer levers: on a line away from axis 1 what a pull down deflects grows.
TEST(Placement, TheNearestPlaceDeflectsLeastUnderAPullDown) {
  const SlicedArm day;
  std::vector<workspace::Offset> offsets;
  for (int i = -2; i <= 2; ++i) offsets.push_back({std::to_string(i), {0.1 * i, 0.0, 0.0}});
  const workspace::PlacementStudy study =
      workspace::studyPlacements(day.arm(), {0.0, 0.0, -1000.0}, {day.postures[2]}, offsets);
  ASSERT_TRUE(study.best && study.now);
  EXPECT_EQ(study.placements[*study.best].offset.id, "-2");
  EXPECT_EQ(*study.now, 2u);
  for (const workspace::Placement& one : study.placements) {
    ASSERT_TRUE(one.judged());
    EXPECT_EQ(one.worst, "c");
    // Statics by hand: c_j times the square of the force's lever about each axis is the deflection along the force.
    const JointVector& q = one.prediction.posture.q;
    const Eigen::Vector3d tcp = day.lab.actual.flangeAt(q) * Eigen::Vector3d(0.0, 0.0, 0.1);
    EXPECT_LT(
        (tcp - (day.lab.actual.flangeAt(day.postures[2].q) * Eigen::Vector3d(0.0, 0.0, 0.1) + one.offset.by)).norm(),
        1e-9);
    const JointVector torque = day.lab.actual.torqueOf(q, 6, tcp, {0.0, 0.0, -1000.0}, Eigen::Vector3d::Zero());
    const double down = torque.cwiseAbs2().dot(day.estimate.compliance) / 1000.0;
    // Finite rotations and K_c of weight and load are within a hundredth.
    EXPECT_NEAR(-one.prediction.tcp.deflection.z(), down, 0.01 * down);
    EXPECT_GT(one.prediction.tcp.expanded, 0.0);
  }
}

TEST(Placement, JudgesAWorkpieceByItsWorstPostureAndNamesWhatItCannotJudge) {
  SlicedArm day;
  const workspace::PlacementStudy both =
      workspace::studyPlacements(day.arm(), {0.0, 0.0, -1000.0}, day.postures, {{"here", Eigen::Vector3d::Zero()}});
  ASSERT_TRUE(both.best);
  double largest = 0.0;
  std::string worst;
  for (const workspace::NamedPosture& one : day.postures) {
    const workspace::PlacementStudy alone =
        workspace::studyPlacements(day.arm(), {0.0, 0.0, -1000.0}, {one}, {{"here", Eigen::Vector3d::Zero()}});
    if (alone.placements[0].deflection() > largest) largest = alone.placements[0].deflection(), worst = one.pose;
  }
  EXPECT_EQ(both.placements[0].worst, worst);
  EXPECT_DOUBLE_EQ(both.placements[0].deflection(), largest);

  day.estimate.identifiable[0] = false;
  day.estimate.compliance[0] = 0.0;
  const workspace::PlacementStudy sideways = workspace::studyPlacements(
      day.arm(), {0.0, 1000.0, 0.0}, {day.postures[1]}, {{"here", Eigen::Vector3d::Zero()}, {"away", {9.0, 0.0, 0.0}}});
  EXPECT_FALSE(sideways.best);
  EXPECT_TRUE(sideways.placements[0].reason.is(compensation::RemarkId::turns_joint_of_unknown_k));
  EXPECT_EQ(sideways.placements[1].reached, 0u);
}

TEST(Placement, OffsetsAreOfAGridOrAFile) {
  const std::vector<workspace::Offset> grid = workspace::offsetGrid(0.2, 1);
  ASSERT_EQ(grid.size(), 27u);
  EXPECT_TRUE(grid[13].by.isZero(0.0));
  EXPECT_TRUE(grid[26].by.isApprox(Eigen::Vector3d(0.2, 0.2, 0.2)));
}

}  // namespace slice_test
}  // namespace stiffscope
