#include "core/planning/unloaded_plan.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/frames/arm_parameters.h"
#include "tests/fixtures/unloaded_day.h"

// Columns of the linear model against the tests' own kinematics and statics.

namespace stiffscope {
namespace unloaded_information_test {

using frames::ArmParameters;

struct Planned {
  UnloadedSpec spec;
  campaign::Campaign campaign;
  planning::PlanningInputs inputs;
  std::vector<JointVector> postures, workspace;

  explicit Planned(int count) {
    campaign.robot = spec.nominal.robot();
    campaign.tracker = campaign::Tracker{"even", spec.noise, 0.0, spec.noise, 0.0, Eigen::Vector3d::Zero()};
    for (std::size_t t = 0; t < spec.on_flange.size(); ++t)
      campaign.targets.push_back({"P" + std::to_string(10 + t), spec.on_flange[t]});
    inputs.repeats = 1;
    inputs.tracker_in_base = spec.tracker_from_base.inverse().translation();
    Noise noise(51);
    for (int i = 0; i < count; ++i) postures.push_back(somePosture(noise));
    for (int i = 0; i < 30; ++i) workspace.push_back(somePosture(noise));
  }
  planning::UnloadedInformation information() const {
    return {campaign, planning::unloadedPlanningArm(campaign, inputs), workspace};
  }
};

// A base shifted by a metre shifts every reflector by one; a reflector shifted in the flange turns with it; a joint's
// compliance turns it by the torque of the own weight. All over the noise of a coordinate.
TEST(UnloadedInformation, ColumnsAreThoseOfTheArm) {
  const Planned planned(3);
  const std::vector<Eigen::MatrixXd> rows = planned.information().rowsOf(planned.postures);
  ASSERT_EQ(rows.size(), 3u);
  const ArmParameters layout(planned.campaign.robot.joints());
  const Eigen::Index geometry = layout.count(3);
  const ChainArm& chain = planned.spec.nominal;
  for (std::size_t p = 0; p < rows.size(); ++p) {
    const JointVector& q = planned.postures[p];
    const auto frames = chain.framesAt(q);
    const JointVector torque = chain.weightTorque(q);
    ASSERT_EQ(rows[p].rows(), 9);
    for (Eigen::Index t = 0; t < 3; ++t) {
      const Eigen::Matrix3d shift = planned.spec.noise * rows[p].block<3, 3>(3 * t, layout.baseAt() + 3);
      EXPECT_LT((shift.cwiseAbs() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-9) << p;
      const Eigen::Matrix3d own =
          planned.spec.noise * rows[p].block<3, 3>(3 * t, layout.targetAt(static_cast<std::size_t>(t)));
      EXPECT_LT((own.transpose() * own - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-9) << p;
      // The first of the effects is joint 2's compliance: joint 1 stands upright and has no torque.
      const Eigen::Vector3d at = frames[6] * planned.spec.on_flange[static_cast<std::size_t>(t)];
      const Eigen::Vector3d axis = frames[1].linear() * chain.axis[1];
      const Eigen::Vector3d turned = torque[1] * axis.cross(at - frames[1].translation());
      const Eigen::Vector3d column = planned.spec.noise * rows[p].block<3, 1>(3 * t, geometry);
      EXPECT_NEAR(std::abs(column.dot(turned)), turned.squaredNorm(), 1e-6 * turned.squaredNorm()) << p;
      EXPECT_NEAR(column.norm(), turned.norm(), 1e-6 * turned.norm()) << p;
    }
  }
}

// Four repeats are half the noise.
TEST(UnloadedInformation, RepeatsAreLessNoise) {
  Planned repeated(30), quiet(30);
  repeated.inputs.repeats = 4;
  quiet.campaign.tracker = campaign::Tracker{"even", 10e-6, 0.0, 10e-6, 0.0, Eigen::Vector3d::Zero()};
  const planning::UnloadedSight one = repeated.information().sightOf(repeated.postures, false),
                                other = quiet.information().sightOf(quiet.postures, false);
  EXPECT_NEAR(one.predicted, other.predicted, 1e-9 * other.predicted);
  EXPECT_LT(one.predicted, Planned(30).information().sightOf(repeated.postures, false).predicted);
}

// What the details promise of prefixes and of single postures, by asking for those sequences.
TEST(UnloadedInformation, DetailsAreThoseOfTheSequencesThemselves) {
  const Planned planned(24);
  const planning::UnloadedInformation information = planned.information();
  const planning::UnloadedSight sight = information.sightOf(planned.postures, true);
  ASSERT_EQ(sight.predicted_after.size(), 24u);
  EXPECT_NEAR(sight.predicted_after.back(), sight.predicted, 1e-9 * sight.predicted);
  for (const double gain : sight.gain) EXPECT_GT(gain, 0.0);
  for (std::size_t i = 1; i < sight.predicted_after.size(); ++i)
    EXPECT_LT(sight.predicted_after[i], sight.predicted_after[i - 1]) << i;
  // Effects of the order are weighed in it too, so that a shorter sequence has other ones: some per cent.
  const std::vector<JointVector> first(planned.postures.begin(), planned.postures.begin() + 12);
  EXPECT_NEAR(information.sightOf(first, false).predicted / sight.predicted_after[11], 1.0, 0.1);
  EXPECT_LE(sight.predicted_geometry, sight.predicted);
  for (const planning::EffectSight& one : sight.effects) EXPECT_GE(one.inflation, 1.0 - 1e-9) << one.effect;
}

}  // namespace unloaded_information_test
}  // namespace stiffscope
