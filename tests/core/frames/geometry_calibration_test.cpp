#include "core/frames/geometry_calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include "core/frames/remarks.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/linear_machine.h"

namespace stiffscope {
namespace geometry_calibration_test {

SimulatedLab labWithErrors() {
  SimulatedLab lab;
  lab.withoutMasses();
  Noise noise(51);
  lab.actual = lab.nominal.disturbed(noise, 1e-3, 1e-3);
  return lab;
}

/// Where the calibrated geometry puts a reflector, in the tracker's frame.
Eigen::Vector3d predicted(const frames::LoadingGeometry& geometry, const JointVector& q, std::size_t target) {
  return geometry.r0_from_loading->inverse() *
         (robot::postureAt(geometry.arm, q).motion[6] * *geometry.targets_at_zero[target]);
}

double worstPrediction(const SimulatedLab& lab, const frames::LoadingGeometry& geometry) {
  Noise noise(99);
  double worst = 0.0;
  for (int i = 0; i < 30; ++i) {
    const JointVector q = somePosture(noise);
    for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, (predicted(geometry, q, k) - lab.seen(q, k)).norm());
  }
  return worst;
}

frames::LoadingGeometry nominalStart(const campaign::Campaign& campaign) {
  return frames::sweptGeometry(campaign, frames::measureFrames(campaign), JointVector::Zero(6));
}

TEST(CalibrateGeometry, FindsTheArmFromPosturesAlone) {
  const SimulatedLab lab = labWithErrors();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, 25, pulledForce);
  const frames::LoadingGeometry start = nominalStart(campaign);
  EXPECT_FALSE(start.r0_from_loading);
  const frames::GeometryCalibration found = frames::calibrateGeometry(campaign, start);
  ASSERT_TRUE(found.done) << reports::words(found.reason);
  EXPECT_EQ(found.positions, 75);
  EXPECT_GT(found.rms_before, 1e-4);  // axes a millimetre and a milliradian off
  EXPECT_LT(found.rms_after, 1e-9);   // noise free: what Ceres stops at
  // At postures it has not seen: exact but for the stop, carried over 3 m.
  EXPECT_LT(worstPrediction(lab, found.geometry), 1e-7);
}

TEST(CalibrateGeometry, FixesAndNamesWhatIsFreeByChoiceOfFrame) {
  // 24 axis parameters, the base and the reflectors: to move base, axes and reflectors together changes
  // nothing, so six are free by choice of frame. R0 is defined by axes 1 and 2: it is theirs that are kept.
  const SimulatedLab lab = labWithErrors();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, 25, pulledForce);
  const frames::GeometryCalibration found = frames::calibrateGeometry(campaign, nominalStart(campaign));
  ASSERT_TRUE(found.done) << reports::words(found.reason);
  EXPECT_EQ(found.fixed.size(), 6u);
  for (const std::string& name : reports::words(found.fixed)) {
    EXPECT_TRUE(name.starts_with("axis 1 ") || name.starts_with("axis 2 ")) << name;
  }
  EXPECT_EQ(std::count_if(found.fixed.begin(), found.fixed.end(),
                          [](const Remark& one) { return reports::words(one).starts_with("axis 1 "); }),
            4);
  EXPECT_EQ(found.parameters, 24 + 6 + 9 - 6);
}

TEST(CalibrateGeometry, AJointThatNeverMovesIsFoundToo) {
  // Joint 4 stands still in all postures: its four parameters are not seen, beside the six.
  const SimulatedLab lab = labWithErrors();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, 25, pulledForce);
  for (std::size_t i = 0; i < campaign.states->rows.size(); ++i) campaign.states->rows[i].q[3] = 0.3;
  for (campaign::LoadingReading& row : campaign.loading->rows) {
    const JointVector& q = campaign.states->rows[2 * static_cast<std::size_t>(row.pose)].q;
    row.point = lab.seen(q, static_cast<std::size_t>(row.target));
  }
  const frames::GeometryCalibration found = frames::calibrateGeometry(campaign, nominalStart(campaign));
  ASSERT_TRUE(found.done) << reports::words(found.reason);
  EXPECT_EQ(found.fixed.size(), 10u);
  EXPECT_LT(found.rms_after, 1e-9);
}

TEST(CalibrateGeometry, StartsFromSweepsWhereThereAreAny) {
  const SimulatedLab lab = labWithErrors();
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  lab.addLoading(campaign, 25, pulledForce);
  const frames::GeometryCalibration found = frames::calibrateGeometry(campaign, nominalStart(campaign));
  ASSERT_TRUE(found.done) << reports::words(found.reason);
  EXPECT_LT(found.rms_before, 1e-8);  // noise free, the sweeps have it already
  EXPECT_LT(worstPrediction(lab, found.geometry), 1e-7);
}

TEST(CalibrateGeometry, NoiseIsNotFitted) {
  // 20 um: what is left over degrees of freedom is the noise, and unseen postures are predicted to a few of
  // it.
  SimulatedLab lab = labWithErrors();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, 40, pulledForce);
  Noise noise(3);
  for (campaign::LoadingReading& row : campaign.loading->rows) row.point += 2e-5 * noise.normal3();
  const frames::GeometryCalibration found = frames::calibrateGeometry(campaign, nominalStart(campaign));
  ASSERT_TRUE(found.done) << reports::words(found.reason);
  const double sigma = found.rms_after * std::sqrt(360.0 / (360.0 - found.parameters));
  EXPECT_NEAR(sigma, 2e-5, 3e-6);  // 327 degrees of freedom: 4 % at one sigma
  EXPECT_LT(worstPrediction(lab, found.geometry), 1.5e-4);
}

TEST(CalibrateGeometry, RefusesWithAReason) {
  const SimulatedLab lab = labWithErrors();
  campaign::Campaign campaign = lab.empty();
  EXPECT_FALSE(frames::calibrateGeometry(campaign, nominalStart(campaign)).reason.empty());
  lab.addLoading(campaign, 2, pulledForce);
  const frames::GeometryCalibration two = frames::calibrateGeometry(campaign, nominalStart(campaign));
  EXPECT_FALSE(two.done);
  EXPECT_TRUE(two.reason.is(frames::RemarkId::base_not_placed)) << reports::words(two.reason);
}

TEST(CalibrateGeometry, FewPosturesFixMoreThanTheChoiceOfFrame) {
  // Three postures of a rigid triangle give 3 x 6 + 3 independent numbers: 21 of 39 parameters, 18 axis
  // parameters fixed.
  const SimulatedLab lab = labWithErrors();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, 3, pulledForce);
  const frames::GeometryCalibration found = frames::calibrateGeometry(campaign, nominalStart(campaign));
  ASSERT_TRUE(found.done) << reports::words(found.reason);
  EXPECT_EQ(found.parameters, 21);
  EXPECT_EQ(found.fixed.size(), 18u);
}

TEST(BaseFromPostures, NominalArmExactly) {
  SimulatedLab lab;
  lab.withoutMasses();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, 5, pulledForce);
  const frames::LoadingGeometry start = nominalStart(campaign);
  const auto found = frames::baseFromPostures(start.arm, frames::unloadedPositions(campaign), 3);
  ASSERT_TRUE(found);
  // The arm's base frame is R0 by the nominal rule: 0.94 m up.
  const Eigen::Isometry3d tracker_from_r0 = lab.tracker_from_base * start.r0_from_base_link.inverse();
  EXPECT_LT((found->points_from_base.matrix() - tracker_from_r0.matrix()).norm(), 1e-9);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LT((start.r0_from_base_link.inverse() * *found->targets_at_zero[k] -
               lab.actual.flangeAt(JointVector::Zero(6)) * lab.targets_in_flange[k])
                  .norm(),
              1e-9);
  }
}

TEST(BaseFromPostures, TurnsAboutOneAxisAreNotEnough) {
  SimulatedLab lab;
  lab.withoutMasses();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, 6, pulledForce);
  for (campaign::State& state : campaign.states->rows) state.q = degrees(10.0 * state.pose, 10, 0, 20, 40, 30);
  for (campaign::LoadingReading& row : campaign.loading->rows) {
    row.point = lab.seen(degrees(10.0 * row.pose, 10, 0, 20, 40, 30), static_cast<std::size_t>(row.target));
  }
  EXPECT_FALSE(frames::baseFromPostures(nominalStart(campaign).arm, frames::unloadedPositions(campaign), 3));
}

}  // namespace geometry_calibration_test
}  // namespace stiffscope
