#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include "core/campaign/read_campaign.h"
#include "core/mistakes/nominal_fit.h"
#include "core/mistakes/spring_fit.h"
#include "tests/fixtures/simulated_lab.h"

// The fit of the URDF's arm to the unloaded readings, and of joint springs to the loads, on days of known truth.

namespace stiffscope {
namespace nominal_fit_test {

/// A noise-free day of the nominal arm, rigid: everything is known.
campaign::Campaign rigidDay(SimulatedLab& lab) {
  lab.withoutMasses();
  return fullDay(lab, [](int) { return Eigen::Vector3d(0.0, 0.0, -800.0); });
}

TEST(NominalFit, FindsBaseAndReflectorsOfARigidDay) {
  SimulatedLab lab;
  const campaign::Campaign campaign = rigidDay(lab);
  const mistakes::NominalFit fit = mistakes::fitNominal(mistakes::readingsOf(campaign));
  ASSERT_TRUE(fit.done);
  EXPECT_LT(fit.rms, 1e-8);  // of metres, by normal equations
  EXPECT_TRUE(fit.base_from_points.isApprox(lab.tracker_from_base.inverse(), 1e-7));
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT((fit.reflectors_in_flange[k] - lab.targets_in_flange[k]).norm(), 1e-7) << k;
}

TEST(NominalFit, FindsTheScale) {
  SimulatedLab lab;
  mistakes::ReadingsOfDay day = mistakes::readingsOf(rigidDay(lab));
  for (mistakes::UnloadedReading& reading : day.unloaded) reading.point *= 1.02;
  EXPECT_GT(mistakes::fitNominal(day).rms, 1e-3);
  const mistakes::NominalFit scaled = mistakes::fitNominal(day, {.scale = true});
  EXPECT_NEAR(scaled.scale, 1.0 / 1.02, 1e-7);
  EXPECT_LT(scaled.rms, 1e-7);
}

// What any linear map may do is no less than what a rigid one leaves, and a mirror is a linear map.
TEST(NominalFit, AffineMisfitIsALowerBoundThatDoesNotSeeMirrors) {
  SimulatedLab lab;
  mistakes::ReadingsOfDay day = mistakes::readingsOf(rigidDay(lab));
  for (mistakes::UnloadedReading& reading : day.unloaded) reading.point.y() *= -1.0;
  EXPECT_LT(mistakes::affineMisfit(day), 1e-3);  // the ridge of directions that are open: 1e-9 of the squares
  EXPECT_GT(mistakes::fitNominal(day).rms, 0.05);
  for (mistakes::UnloadedReading& reading : day.unloaded) reading.q[1] *= -1.0;
  EXPECT_LE(mistakes::affineMisfit(day), mistakes::fitNominal(day).rms);
  EXPECT_GT(mistakes::affineMisfit(day), 0.05);
}

TEST(NominalFit, AGroupApartDoesNotPullTheOthers) {
  SimulatedLab lab;
  mistakes::ReadingsOfDay day = mistakes::readingsOf(rigidDay(lab));
  const int last = day.groups - 1;
  for (mistakes::UnloadedReading& reading : day.unloaded) {
    if (reading.group == last) reading.point += Eigen::Vector3d(0.3, -0.2, 0.1);
  }
  const mistakes::NominalFit fit = mistakes::fitNominal(day);
  EXPECT_LT(fit.typical, 1e-3);
  EXPECT_NEAR(fit.group_rms[static_cast<std::size_t>(last)], 0.374, 0.02);  // root of 0.14, less what still pulls
}

TEST(NominalFit, SaysNothingOfTooFewReadings) {
  campaign::Campaign campaign;
  campaign.targets.push_back({"P1", {}});
  EXPECT_FALSE(mistakes::fitNominal(mistakes::readingsOf(campaign)).done);
}

class Loads : public ::testing::Test {
 protected:
  Loads() {
    lab.compliance << 2e-7, 3e-7, 4e-7, 2e-6, 4e-6, 6e-6;
    campaign = rigidDay(lab);
    day = mistakes::readingsOf(campaign);
    arm = mistakes::fitNominal(day);
  }
  SimulatedLab lab;
  campaign::Campaign campaign;
  mistakes::ReadingsOfDay day;
  mistakes::NominalFit arm;
};

TEST_F(Loads, SpringsExplainALoadThatHangs) {
  const mistakes::SpringFit fit = mistakes::LoadsOfDay(day, arm).fit(mistakes::asDeclared(*campaign.load_cell));
  EXPECT_LT(fit.left, 0.02);         // Jacobians are those of the unloaded arm: some milliradians
  EXPECT_LT(fit.off_gravity, 0.02);  // the cell turns with the flange by as much
  EXPECT_NEAR(fit.lever, (lab.hook_in_flange - lab.flange_from_cell.translation()).norm(), 1e-3);
  for (int j = 1; j < 5; ++j) EXPECT_NEAR(fit.compliance[j] / lab.compliance[j], 1.0, 0.03) << j;
}

TEST_F(Loads, SpringsThatWouldHaveToPushExplainNothing) {
  mistakes::CellReading turned = mistakes::asDeclared(*campaign.load_cell);
  turned.on_force = turned.on_moment = -Eigen::Matrix3d::Identity();
  const mistakes::SpringFit fit = mistakes::LoadsOfDay(day, arm).fit(turned);
  EXPECT_GT(fit.left, 0.9);
  EXPECT_NEAR(fit.off_gravity, std::numbers::pi, 0.02);
  EXPECT_TRUE((fit.compliance.array() >= 0.0).all());
}

TEST_F(Loads, TheTurnOntoGravityIsThatOfTheCell) {
  const Eigen::Matrix3d wrong = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  mistakes::CellReading cell = mistakes::asDeclared(*campaign.load_cell);
  cell.parent_from_cell.linear() *= wrong;
  const auto turn = mistakes::LoadsOfDay(day, arm).turnToGravity(cell);
  ASSERT_TRUE(turn);
  EXPECT_LT(Eigen::AngleAxisd(wrong * *turn).angle(), 0.02);
}

TEST_F(Loads, ThePointIsThatOfTheCell) {
  mistakes::CellReading cell = mistakes::asDeclared(*campaign.load_cell);
  cell.parent_from_cell.translation() += Eigen::Vector3d(0.5, -0.3, 0.4);
  const Eigen::Vector3d found = mistakes::LoadsOfDay(day, arm).bestPoint(cell);
  EXPECT_LT((found - lab.flange_from_cell.translation()).norm(), 0.02);
}

}  // namespace nominal_fit_test
}  // namespace stiffscope
