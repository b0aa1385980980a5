#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include "core/workspace/point_stiffness.h"
#include "tests/fixtures/known_arm.h"

namespace stiffscope {
namespace point_stiffness_test {

struct PlacedArm : KnownArm {
  compensation::Certainty certainty{{}, compensation::IdentifiedRange(6)};
  JointVector q = degrees(20, 10, -20, 50, 60, -30);

  PlacedArm() {
    certainty.draws = compensation::springDraws(estimate, estimate.covariance);
    geometry.compliance = estimate.compliance;
  }
  workspace::DeflectingArm arm(const effects::EffectDeflection* with = nullptr) const {
    return {campaign, geometry, estimate, Eigen::Vector3d(0.0, 0.0, 0.1), with, &certainty};
  }
  /// The arm at rest by its springs, as an arm with effects is handed over.
  effects::EffectDeflection springsAsEffects() const {
    effects::EffectDeflection with;
    with.spring_covariance = JointMatrix::Zero(6, 6);
    with.flange = [this](const JointVector& commands, const effects::FlangeLoad& load) {
      const auto angles = effects::loadedAngles(geometry, estimate.compliance, commands, load);
      return std::optional<Eigen::Isometry3d>(
          robot::flangeAt(geometry.arm, robot::postureAt(geometry.arm, angles.value())));
    };
    return with;
  }
};

TEST(PointStiffness, IsWhatTheArmDoesUnderAForce) {
  const PlacedArm day;
  const auto place = workspace::pointStiffness(day.arm(), day.q);
  ASSERT_TRUE(place);
  ASSERT_EQ(place->of_springs.size(), 3u);
  EXPECT_TRUE(place->unknown.empty());
  const effects::EffectDeflection springs = day.springsAsEffects();
  for (const workspace::DirectionalCompliance& one : place->of_springs) {
    const Eigen::Vector3d force = 100.0 * one.direction;
    const Eigen::Vector3d tcp(0.0, 0.0, 0.1);
    const Eigen::Vector3d move = *springs.flange(day.q, {tcp, force, Eigen::Vector3d::Zero()}) * tcp -
                                 *springs.flange(day.q, effects::FlangeLoad()) * tcp;
    // K_c of the arm's own weight, which C_x leaves out, is some thousandths of the softest direction's.
    EXPECT_NEAR(one.direction.dot(move) / 100.0, one.compliance, 5e-3 * place->of_springs.front().compliance);
    EXPECT_NEAR((place->springs * one.direction - one.compliance * one.direction).norm(), 0.0, 1e-12);
  }
  EXPECT_GE(place->of_springs[0].compliance, place->of_springs[1].compliance);
  EXPECT_GE(place->of_springs[1].compliance, place->of_springs[2].compliance);
}

TEST(PointStiffness, TheModelsComplianceIsProbed) {
  const PlacedArm day;
  const effects::EffectDeflection springs = day.springsAsEffects();
  const auto alone = workspace::pointStiffness(day.arm(), day.q),
             with = workspace::pointStiffness(day.arm(&springs), day.q);
  ASSERT_TRUE(alone && with);
  EXPECT_TRUE(alone->springs.isApprox(with->springs, 0.0));
  EXPECT_LT((with->model - with->springs).norm(), 5e-3 * with->springs.norm());  // K_c of the own weight, as above
  EXPECT_GT((with->model - with->springs).norm(), 1e-6 * with->springs.norm());
}

// U of a principal compliance: its derivative by each joint's c is the square of the joint's move along it.
TEST(PointStiffness, IntervalIsThatOfTheSprings) {
  const PlacedArm day;
  const auto place = workspace::pointStiffness(day.arm(), day.q);
  ASSERT_TRUE(place);
  for (const workspace::DirectionalCompliance& one : place->of_springs) {
    double variance = 0.0;
    for (int joint = 0; joint < 6; ++joint) {
      PlacedArm softer = day;
      const double step = 1e-3 * day.estimate.compliance[joint];
      softer.estimate.compliance[joint] += step;
      const Eigen::Matrix3d more = workspace::pointStiffness(softer.arm(), day.q)->springs;
      const double slope = one.direction.dot((more - place->springs) * one.direction) / step;
      variance += slope * slope * day.estimate.covariance(joint, joint);
    }
    // Quantiles of 3000 draws at 2.5 % are known to 5 % of the standard deviation; four of these.
    EXPECT_NEAR(one.interval.high - one.compliance, 1.96 * std::sqrt(variance), 0.2 * std::sqrt(variance));
    EXPECT_NEAR(one.compliance - one.interval.low, 1.96 * std::sqrt(variance), 0.2 * std::sqrt(variance));
    EXPECT_DOUBLE_EQ(one.stiffness(), 1.0 / one.compliance);
    EXPECT_DOUBLE_EQ(one.stiffnessInterval().low, 1.0 / one.interval.high);
  }
}

// What hides only gives: beside the quantiles of its draws, which leave nothing below the model, the interval holds k u
// with the fit's own variance to either side.
TEST(PointStiffness, WhatHidesDoesNotTakeTheFitsOwnErrorAway) {
  PlacedArm day;
  const auto alone = workspace::pointStiffness(day.arm(), day.q);
  compensation::DeflectionDraws& draws = day.certainty.draws;
  static constexpr double kMore = 2e-8;  // m/N by one unit, in every direction
  const Eigen::Index count = draws.size();
  draws.compliance.setZero();
  draws.parameters = Eigen::RowVectorXd::LinSpaced(count, 0.0, 1.0);
  draws.by = [](const JointVector&, const effects::FlangeLoad& load, const std::vector<Eigen::Vector3d>&) {
    return Eigen::MatrixXd(kMore * load.force);
  };
  const auto place = workspace::pointStiffness(day.arm(), day.q);
  ASSERT_TRUE(alone && place);
  ASSERT_EQ(place->of_model.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const workspace::DirectionalCompliance& one = place->of_model[k];
    // The interval by springs alone is that of the fit, to 5 % of a standard deviation at each end.
    const double fit = 0.5 * (alone->of_model[k].interval.high - alone->of_model[k].interval.low) / 1.96;
    const double half = 1.96 * std::hypot(0.6827 * kMore, fit);
    EXPECT_NEAR(one.compliance - one.interval.low, half, 0.05 * half);
    EXPECT_NEAR(one.interval.high - one.compliance, std::max(half, 0.975 * kMore), 0.05 * half);
    // The joints' springs, of which the draws say nothing here, keep the fit's own interval.
    const workspace::DirectionalCompliance& springs = place->of_springs[k];
    EXPECT_NEAR(springs.compliance - springs.interval.low, 1.96 * fit, 0.05 * 1.96 * fit);
    EXPECT_NEAR(springs.interval.high - springs.compliance, 1.96 * fit, 0.05 * 1.96 * fit);
  }
}

// Without k1 nothing is said of the direction in which joint 1 moves P_TCP, and the others stay as they are.
TEST(PointStiffness, AJointOfUnknownStiffnessTakesItsDirectionAway) {
  PlacedArm day;
  const auto all = workspace::pointStiffness(day.arm(), day.q);
  day.estimate.identifiable[0] = false;
  day.estimate.compliance[0] = 0.0;
  const auto place = workspace::pointStiffness(day.arm(), day.q);
  ASSERT_TRUE(all && place);
  EXPECT_EQ(place->unknown, std::vector<int>{0});
  ASSERT_EQ(place->of_springs.size(), 2u);
  const Eigen::Vector3d sideways = Eigen::Vector3d::UnitZ().cross(place->tcp).normalized();
  for (const workspace::DirectionalCompliance& one : place->of_springs) {
    EXPECT_NEAR(one.direction.dot(sideways), 0.0, 1e-4);  // axis 1 of the disturbed arm is not quite z0
    EXPECT_NEAR(one.direction.dot(all->springs * one.direction), one.compliance, 1e-9 * one.compliance);
  }
  day.estimate.identifiable[0] = true;
  day.estimate.compliance[0] = -1e-7;  // no spring
  EXPECT_EQ(workspace::pointStiffness(day.arm(), day.q)->unknown, std::vector<int>{0});
  // Of a wholly unknown arm nothing is said.
  day.estimate.identifiable.assign(6, false);
  day.estimate.compliance.setZero();
  EXPECT_TRUE(workspace::pointStiffness(day.arm(), day.q)->of_springs.empty());
}

}  // namespace point_stiffness_test
}  // namespace stiffscope
