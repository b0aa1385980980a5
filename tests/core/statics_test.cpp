#include <gtest/gtest.h>

#include "core/statics/geometric_stiffness.h"
#include "core/statics/joint_torque.h"
#include "core/statics/own_weight.h"
#include "tests/core/example_arm.h"

namespace stiffscope {
namespace {

const Vector6d kPosture = (Vector6d() << 0.3, 0.4, -0.5, 0.6, 0.7, -0.8).finished();
const Vector6d kCompliance = (Vector6d() << 1 / 4.0, 1 / 3.2, 1 / 2.6, 1 / 0.42, 1 / 0.23, 1 / 0.089).finished() * 1e-6;

OwnWeight weightOf(const Robot& arm) {
  OwnWeight weight;
  weight.bodies = arm.bodies;
  weight.gravity_in_base = {0, 0, -9.80665};
  weight.links_known = true;
  return weight;
}

/// The hanging load as a dead force at a point of the flange body that stands at `hook_at_zero` at zero.
Wrench hanging(const ArmPosture& posture, const Eigen::Vector3d& hook_at_zero, double newton) {
  return {posture.motion[6] * hook_at_zero, {0, 0, -newton}, Eigen::Vector3d::Zero()};
}

TEST(JointTorque, SameWhereverTheWrenchIsReduced) {
  const Robot arm = exampleArm();
  const ArmPosture posture = postureAt(arm, kPosture);
  const Wrench wrench{{1.2, 0.3, 1.7}, {300, -200, -1500}, {40, 50, -60}};
  const Vector6d there = jointTorque(arm, posture, wrench);
  const Vector6d elsewhere = jointTorque(arm, posture, wrench.about({-3.0, 2.0, 5.0}));
  EXPECT_LT((there - elsewhere).norm(), 1e-9 * there.norm());  // rounding only
}

TEST(JointTorque, AHandCase) {
  // Straight out at zero: 1 kN down at the flange, 1.585 m ahead of axis 2, 1.995 - 1.695 = 0.3 m ahead of axis 5.
  const Robot arm = exampleArm();
  const Vector6d torque =
      jointTorque(arm, postureAt(arm, Vector6d::Zero()), {{1.995, 0, 2.31}, {0, 0, -1000}, {0, 0, 0}});
  EXPECT_NEAR(torque[0], 0.0, 1e-9);
  EXPECT_NEAR(torque[1], 1585.0, 1e-9);
  EXPECT_NEAR(torque[2], -1585.0, 1e-9);
  EXPECT_NEAR(torque[4], -300.0, 1e-9);
  EXPECT_NEAR(torque[5], 0.0, 1e-9);
}

TEST(OwnWeight, TorqueIsTheSumOverBodies) {
  const Robot arm = exampleArm();
  const OwnWeight weight = weightOf(arm);
  const ArmPosture posture = postureAt(arm, kPosture);
  Vector6d sum = Vector6d::Zero();
  for (std::size_t body = 1; body <= 6; ++body) {
    const Wrench pull{posture.motion[body] * weight.bodies[body].com_in_base_at_zero,
                      weight.bodies[body].mass_kg * weight.gravity_in_base, Eigen::Vector3d::Zero()};
    Vector6d one = jointTorque(arm, posture, pull);
    one.tail(6 - static_cast<Eigen::Index>(body)).setZero();  // joints beyond the body do not carry it
    sum += one;
  }
  EXPECT_LT((weightTorque(arm, posture, weight) - sum).norm(), 1e-9 * sum.norm());
}

TEST(GeometricStiffness, IsTheDerivativeOfTheTorques) {
  const Robot arm = exampleArm();
  const OwnWeight weight = weightOf(arm);
  const Eigen::Vector3d hook = arm.base_from_flange_at_zero * Eigen::Vector3d(0.05, -0.1, 0.4);
  const ArmPosture posture = postureAt(arm, kPosture);
  Wrench load = hanging(posture, hook, 1500.0);
  load.moment = {100.0, -50.0, 70.0};
  const ArmAxes axes = axesAt(arm, posture);
  const Matrix6d stiffness = geometricStiffness(axes, load) + geometricStiffness(axes, posture, weight);
  Matrix6d numeric;
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 6; ++k) {
    Vector6d sides[2];
    for (int side = 0; side < 2; ++side) {
      const ArmPosture moved = postureAt(arm, kPosture + (side ? 1 : -1) * kStep * Vector6d::Unit(k));
      Wrench moved_load = hanging(moved, hook, 1500.0);
      moved_load.moment = load.moment;
      sides[side] = jointTorque(arm, moved, moved_load) + weightTorque(arm, moved, weight);
    }
    numeric.col(k) = (sides[1] - sides[0]) / (2 * kStep);
  }
  // Differences of numbers of 1e4 Nm over 2e-6 rad keep about 1e-6 of the largest entry.
  EXPECT_LT((stiffness - numeric).cwiseAbs().maxCoeff(), 1e-5 * stiffness.cwiseAbs().maxCoeff());
}

TEST(GeometricStiffness, LeavesSecondOrderOfTheNonlinearDisplacement) {
  // Equilibrium of the springs with all loads on the moved arm, by iteration, against the linear formula with K_c.
  const Robot arm = exampleArm();
  const OwnWeight weight = weightOf(arm);
  const Eigen::Vector3d hook = arm.base_from_flange_at_zero * Eigen::Vector3d(0.05, -0.1, 0.4);
  const auto settle = [&](double newton) {
    Vector6d q = kPosture;
    for (int i = 0; i < 50; ++i) {
      const ArmPosture posture = postureAt(arm, q);
      q = kPosture + kCompliance.cwiseProduct(weightTorque(arm, posture, weight) +
                                              jointTorque(arm, posture, hanging(posture, hook, newton)));
    }
    return q;
  };
  const Vector6d unloaded = settle(0.0);
  const ArmPosture posture = postureAt(arm, unloaded);
  const auto errors = [&](double newton) {
    const Vector6d turn = settle(newton) - unloaded;
    const Wrench load = hanging(posture, hook, newton);
    const Vector6d torque = jointTorque(arm, posture, load);
    const ArmAxes axes = axesAt(arm, posture);
    const Matrix6d change = geometricStiffness(axes, load) + geometricStiffness(axes, posture, weight);
    const Vector6d neglected = kCompliance.cwiseProduct(torque);
    const Vector6d included = kCompliance.cwiseProduct(
        (Matrix6d::Identity() - change * kCompliance.asDiagonal().toDenseMatrix()).inverse() * torque);
    return std::pair{(turn - neglected).norm() / turn.norm(), (turn - included).norm() / turn.norm()};
  };
  const auto [neglected, included] = errors(1500.0);
  EXPECT_GT(neglected, 1e-3);
  EXPECT_LT(included, 1e-4);  // what is left is of the order of the square of the turning, 1e-3 rad
}

}  // namespace
}  // namespace stiffscope
