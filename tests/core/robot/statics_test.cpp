#include <gtest/gtest.h>
#include "core/robot/geometric_stiffness.h"
#include "core/robot/gravity_load.h"
#include "core/robot/wrench.h"
#include "tests/fixtures/example_arm.h"

namespace stiffscope {
namespace statics_test {

const Vector6d kPosture = (Vector6d() << 0.3, 0.4, -0.5, 0.6, 0.7, -0.8).finished();
const Vector6d kCompliance = (Vector6d() << 1 / 4.0, 1 / 3.2, 1 / 2.6, 1 / 0.42, 1 / 0.23, 1 / 0.089).finished() * 1e-6;

robot::GravityLoad weightOf(const robot::Robot& arm) {
  robot::GravityLoad weight;
  weight.bodies = arm.bodies;
  weight.gravity_in_base = {0, 0, -9.80665};
  weight.links_known = true;
  return weight;
}

/// The hanging load as a dead force at a point of the flange body that stands at `hook_at_zero` at zero.
robot::Wrench hanging(const robot::ArmPosture& posture, const Eigen::Vector3d& hook_at_zero, double newton) {
  return {posture.motion[6] * hook_at_zero, {0, 0, -newton}, Eigen::Vector3d::Zero()};
}

TEST(JointTorque, SameWhereverTheWrenchIsReduced) {
  const robot::Robot arm = exampleArm();
  const robot::ArmPosture posture = robot::postureAt(arm, kPosture);
  const robot::Wrench wrench{{1.2, 0.3, 1.7}, {300, -200, -1500}, {40, 50, -60}};
  const Vector6d there = robot::jointTorque(arm, posture, wrench);
  const Vector6d elsewhere = robot::jointTorque(arm, posture, wrench.about({-3.0, 2.0, 5.0}));
  EXPECT_LT((there - elsewhere).norm(), 1e-9 * there.norm());  // rounding only
}

TEST(JointTorque, AHandCase) {
  // Straight out at zero: 1 kN down at the flange, 1.585 m ahead of axis 2, 1.995 - 1.695 = 0.3 m ahead of axis 5.
  const robot::Robot arm = exampleArm();
  const Vector6d torque =
      robot::jointTorque(arm, robot::postureAt(arm, Vector6d::Zero()), {{1.995, 0, 2.31}, {0, 0, -1000}, {0, 0, 0}});
  EXPECT_NEAR(torque[0], 0.0, 1e-9);
  EXPECT_NEAR(torque[1], 1585.0, 1e-9);
  EXPECT_NEAR(torque[2], -1585.0, 1e-9);
  EXPECT_NEAR(torque[4], -300.0, 1e-9);
  EXPECT_NEAR(torque[5], 0.0, 1e-9);
}

TEST(GravityLoad, TorqueIsTheSumOverBodies) {
  const robot::Robot arm = exampleArm();
  const robot::GravityLoad weight = weightOf(arm);
  const robot::ArmPosture posture = robot::postureAt(arm, kPosture);
  Vector6d sum = Vector6d::Zero();
  for (std::size_t body = 1; body <= 6; ++body) {
    const robot::Wrench pull{posture.motion[body] * weight.bodies[body].com_in_base_at_zero,
                             weight.bodies[body].mass_kg * weight.gravity_in_base, Eigen::Vector3d::Zero()};
    Vector6d one = robot::jointTorque(arm, posture, pull);
    one.tail(6 - static_cast<Eigen::Index>(body)).setZero();  // joints beyond the body do not carry it
    sum += one;
  }
  EXPECT_LT((robot::weightTorque(arm, posture, weight) - sum).norm(), 1e-9 * sum.norm());
}

TEST(GeometricStiffness, IsTheDerivativeOfTheTorques) {
  const robot::Robot arm = exampleArm();
  const robot::GravityLoad weight = weightOf(arm);
  const Eigen::Vector3d hook = arm.base_from_flange_at_zero * Eigen::Vector3d(0.05, -0.1, 0.4);
  const robot::ArmPosture posture = robot::postureAt(arm, kPosture);
  robot::Wrench load = hanging(posture, hook, 1500.0);
  load.moment = {100.0, -50.0, 70.0};
  const robot::ArmAxes axes = robot::axesAt(arm, posture);
  const Matrix6d stiffness = robot::geometricStiffness(axes, load) + robot::geometricStiffness(axes, posture, weight);
  Matrix6d numeric;
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 6; ++k) {
    Vector6d sides[2];
    for (int side = 0; side < 2; ++side) {
      const robot::ArmPosture moved = robot::postureAt(arm, kPosture + (side ? 1 : -1) * kStep * Vector6d::Unit(k));
      robot::Wrench moved_load = hanging(moved, hook, 1500.0);
      moved_load.moment = load.moment;
      sides[side] = robot::jointTorque(arm, moved, moved_load) + robot::weightTorque(arm, moved, weight);
    }
    numeric.col(k) = (sides[1] - sides[0]) / (2 * kStep);
  }
  // Differences of numbers of 1e4 Nm over 2e-6 rad keep about 1e-6 of the largest entry.
  EXPECT_LT((stiffness - numeric).cwiseAbs().maxCoeff(), 1e-5 * stiffness.cwiseAbs().maxCoeff());
}

TEST(GeometricStiffness, LeavesSecondOrderOfTheNonlinearDisplacement) {
  // Equilibrium of the springs with all loads on the moved arm, by iteration, against the linear formula with K_c.
  const robot::Robot arm = exampleArm();
  const robot::GravityLoad weight = weightOf(arm);
  const Eigen::Vector3d hook = arm.base_from_flange_at_zero * Eigen::Vector3d(0.05, -0.1, 0.4);
  const auto settle = [&](double newton) {
    Vector6d q = kPosture;
    for (int i = 0; i < 50; ++i) {
      const robot::ArmPosture posture = robot::postureAt(arm, q);
      q = kPosture + kCompliance.cwiseProduct(robot::weightTorque(arm, posture, weight) +
                                              robot::jointTorque(arm, posture, hanging(posture, hook, newton)));
    }
    return q;
  };
  const Vector6d unloaded = settle(0.0);
  const robot::ArmPosture posture = robot::postureAt(arm, unloaded);
  const auto errors = [&](double newton) {
    const Vector6d turn = settle(newton) - unloaded;
    const robot::Wrench load = hanging(posture, hook, newton);
    const Vector6d torque = robot::jointTorque(arm, posture, load);
    const robot::ArmAxes axes = robot::axesAt(arm, posture);
    const Matrix6d change = robot::geometricStiffness(axes, load) + robot::geometricStiffness(axes, posture, weight);
    const Vector6d neglected = kCompliance.cwiseProduct(torque);
    const Vector6d included = kCompliance.cwiseProduct(
        (Matrix6d::Identity() - change * kCompliance.asDiagonal().toDenseMatrix()).inverse() * torque);
    return std::pair{(turn - neglected).norm() / turn.norm(), (turn - included).norm() / turn.norm()};
  };
  const auto [neglected, included] = errors(1500.0);
  EXPECT_GT(neglected, 1e-3);
  EXPECT_LT(included, 1e-4);  // what is left is of the order of the square of the turning, 1e-3 rad
}

}  // namespace statics_test
}  // namespace stiffscope
