#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnosis/gap_study.h"
#include "core/preparation/prepare.h"
#include "tests/fixtures/extended_day.h"

// Effects that bend with their own size are judged at the shape that they settle at, whether chosen or not.

namespace stiffscope {
namespace rival_shapes_test {

using diagnosis::GapStudy;

/// The samples' machine whose joint 2 has k theta + k_3 theta^3 = tau.
GapStudy hardeningDay(std::uint64_t seed) {
  simulation::SimulationSpec spec = springsAlone(seed);
  const double rate = *spec.machine.joints[1].torsion;
  constexpr double kTurn = 5e-3;  // rad, where the cubic term is as large as the linear one
  spec.machine.joints[1].cubic = rate / (kTurn * kTurn);
  return diagnosis::studyGap(preparation::prepareCampaign(simulation::simulate(spec)));
}

// What was not chosen has settled, too: the play that imitates the spring best, its passage as wide as a passage may
// be.
TEST(RivalShapes, ThoseNotChosenHaveSettled) {
  const GapStudy study = hardeningDay(3);
  ASSERT_TRUE(study.usable());
  const effects::LinearizationPoint& at = study.fit.state.at;
  EXPECT_GT(at.play[1], 0.0);
  EXPECT_GT(at.passage, 2.0 * effects::LinearizationPoint().passage);
  EXPECT_GT(at.harder_by_size[1], 0.0);
}

TEST(RivalShapes, NothingBendsWhereNothingIsWorthIt) {
  const GapStudy study = diagnosis::studyGap(preparation::prepareCampaign(simulation::simulate(springsAlone(4))));
  ASSERT_TRUE(study.usable());
  const effects::LinearizationPoint& at = study.fit.state.at;
  EXPECT_TRUE(study.fit.set.models.empty());
  EXPECT_TRUE(at.play.isZero(0.0));
  EXPECT_EQ(at.passage, effects::LinearizationPoint().passage);
  EXPECT_TRUE(at.harder_by_square.isZero(0.0));
  EXPECT_TRUE(at.harder_by_size.isZero(0.0));
}

// theta = c tau / (1 + a |tau|) with a < 0, fitted as c tau - h * column and settled again and again.
TEST(RivalShapes, ASofteningSpringSettlesWithoutSwinging) {
  const std::vector<effects::EffectModel> models =
      effects::modelsOf(effects::jointHardening(), {.joints = 6, .targets = {"A"}});
  const auto model = std::find_if(models.begin(), models.end(), [](const effects::EffectModel& one) {
    return one.shape == "stiffness with the size of the torque, to any size";
  });
  ASSERT_NE(model, models.end());
  constexpr double kCompliance = 1e-6, kLargest = 1000.0, kDrop = -0.45 / kLargest;
  effects::LinearizationPoint at(6);
  at.largest_torque.setConstant(kLargest);
  constexpr int kRounds = 6, kStates = 20;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixX2d columns(kStates, 2);
    Eigen::VectorXd angle(kStates);
    for (int s = 0; s < kStates; ++s) {
      effects::ArmState state;
      state.load_torque = JointVector::Constant(6, kLargest * (s + 1) / kStates);
      state.weight_torque = JointVector::Zero(6);
      const double torque = state.load_torque[0];
      columns.row(s) << torque, model->angles(at, {state}, 0)(0, 0);
      angle[s] = kCompliance * torque / (1.0 + kDrop * torque);
    }
    const Eigen::VectorXd scale = columns.colwise().norm().transpose();
    const Eigen::Vector2d fitted =
        (columns * scale.cwiseInverse().asDiagonal()).colPivHouseholderQr().solve(angle).cwiseQuotient(scale);
    at.compliance.setConstant(fitted[0]);
    Eigen::VectorXd own = Eigen::VectorXd::Constant(6, fitted[1]);
    model->settle(at, own);
  }
  EXPECT_NEAR(at.harder_by_size[0], kDrop, 0.02 * std::abs(kDrop));
}

}  // namespace rival_shapes_test
}  // namespace stiffscope
