// A palletiser whose rods keep the flange level: it turns about the upright alone, and postures tell the height of its
// base only together with that of the reflectors on the flange.
#include <gtest/gtest.h>

#include "core/campaign/campaign.h"
#include "core/frames/coupled_axes.h"
#include "core/frames/geometry_calibration.h"
#include "core/frames/remarks.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/level_flange.h"

namespace stiffscope {
namespace level_flange_test {

using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

const LevelFlange kMachine;
const std::vector<Vector3d>& kOnFlange = kMachine.on_flange;
const Isometry3d& kStationFromBase = kMachine.station_from_base;

campaign::Campaign day(int postures, bool turning = true) { return kMachine.unloaded(postures, turning); }

std::vector<std::optional<Vector3d>> atZero(const campaign::Campaign& campaign) {
  std::vector<std::optional<Vector3d>> places;
  for (const Vector3d& place : kOnFlange) places.emplace_back(campaign.robot.base_from_flange_at_zero * place);
  return places;
}

TEST(LevelFlange, PosturesPlaceTheBaseButForItsHeight) {
  const campaign::Campaign campaign = day(8);
  auto found = frames::baseFromPostures(campaign.robot, frames::unloadedPositions(campaign), 3);
  ASSERT_TRUE(found);
  ASSERT_TRUE(found->open);
  EXPECT_LT(found->open->cross(Vector3d::UnitZ()).norm(), 1e-7);
  EXPECT_LT((found->points_from_base.linear() - kStationFromBase.linear()).norm(), 1e-7);
  const std::vector<std::optional<Vector3d>> truth = atZero(campaign);
  // The mean of the reflectors is put at the flange's height; they stand 0.31/3 above it.
  const Vector3d off =
      kStationFromBase.linear().transpose() * (found->points_from_base.translation() - kStationFromBase.translation());
  EXPECT_LT((off - Vector3d(0, 0, 0.31 / 3)).norm(), 1e-7);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT((*found->targets_at_zero[k] - *truth[k] + Vector3d(0, 0, 0.31 / 3)).norm(), 1e-7);

  // What is stated of the reflectors counts before what is stated of the base.
  frames::BaseFromPostures by_base = *found;
  frames::slideToStated(truth, Isometry3d(Translation3d(0, 0, 5)), *found);
  EXPECT_LT((found->points_from_base.matrix() - kStationFromBase.matrix()).norm(), 1e-7);
  frames::slideToStated({{}, {}, {}}, kStationFromBase, by_base);
  EXPECT_LT((by_base.points_from_base.matrix() - kStationFromBase.matrix()).norm(), 1e-7);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT((*by_base.targets_at_zero[k] - *truth[k]).norm(), 1e-7);
}

TEST(LevelFlange, WithoutAnyTurnNothingPlacesIt) {
  const campaign::Campaign campaign = day(8, false);
  EXPECT_FALSE(frames::baseFromPostures(campaign.robot, frames::unloadedPositions(campaign), 3));
}

TEST(LevelFlange, CalibrationSaysWhatNoPostureTells) {
  const campaign::Campaign campaign = day(20);
  const frames::LoadingGeometry start =
      frames::sweptGeometry(campaign, frames::measureFrames(campaign), JointVector::Zero(4));
  const frames::GeometryCalibration found = frames::calibrateGeometry(campaign, start);
  ASSERT_TRUE(found.done) << reports::words(found.reason);
  EXPECT_LT(found.rms_after, 1e-9);
  const auto told = std::find_if(found.fixed.begin(), found.fixed.end(),
                                 [](const Remark& one) { return one.is(frames::RemarkId::base_against_reflectors); });
  ASSERT_NE(told, found.fixed.end());
  EXPECT_NE(reports::words(*told).find("1 combination of the base's place"), std::string::npos)
      << reports::words(*told);
  // Nothing that noise leaves open is among what was estimated.
  for (const frames::LoadingGeometry& one : found.spread) {
    EXPECT_LT((one.r0_from_loading->translation() - found.geometry.r0_from_loading->translation()).norm(), 0.01);
  }
}

TEST(LevelFlange, AStatedBaseServesOneReflector) {
  campaign::Campaign campaign = day(20);
  std::erase_if(campaign.loading->rows, [](const campaign::LoadingReading& one) { return one.target != 0; });
  const auto calibrated = [&] {
    return frames::calibrateGeometry(
        campaign, frames::sweptGeometry(campaign, frames::measureFrames(campaign), JointVector::Zero(4)));
  };
  const frames::GeometryCalibration without = calibrated();
  ASSERT_FALSE(without.done);
  EXPECT_TRUE(without.reason.is(frames::RemarkId::base_not_placed));
  EXPECT_NE(reports::words(without.reason).find("`displacements`"), std::string::npos);
  for (campaign::LoadingReading& one : campaign.loading->rows) one.point = kStationFromBase.inverse() * one.point;
  campaign.loading->frame = campaign::PointFrame::base_link;
  const frames::GeometryCalibration with = calibrated();
  ASSERT_TRUE(with.done) << reports::words(with.reason);
  EXPECT_LT(with.rms_after, 1e-9);
}

TEST(LevelFlange, SweepsDoNotPlaceItsAxes) {
  campaign::Campaign campaign = day(3);
  campaign.circle_sweeps.emplace();
  for (int joint = 0; joint < 4; ++joint) {
    for (int stop = 0; stop < 12; ++stop) {
      JointVector q(4);
      q << 0.2, -0.1, 0.2, 0.3;
      q[joint] += (stop - 6) * 0.1;
      for (std::size_t k = 0; k < kOnFlange.size(); ++k) {
        campaign::CircleReading row;
        row.axis = joint;
        row.target = static_cast<int>(k);
        row.q = q;
        row.point = kMachine.seen(q, k);
        campaign.circle_sweeps->rows.push_back(row);
      }
    }
  }
  frames::RigidPoints points;
  for (const campaign::CircleReading& row : campaign.circle_sweeps->rows) points.circle_sweeps.push_back(row.point);
  const frames::CoupledAxes axes = frames::fitCoupledAxes(campaign, points);
  EXPECT_TRUE(axes.reason.is(frames::RemarkId::coupled_flange_level)) << reports::words(axes.reason);
  EXPECT_TRUE(axes.at_zero.empty());
}

}  // namespace level_flange_test
}  // namespace stiffscope
