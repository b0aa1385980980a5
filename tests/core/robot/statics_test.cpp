#include <gtest/gtest.h>
#include "core/robot/geometric_stiffness.h"
#include "core/robot/gravity_load.h"
#include "core/robot/wrench.h"
#include "tests/fixtures/chain_arm.h"
#include "tests/fixtures/example_arm.h"

namespace stiffscope {
namespace statics_test {

const JointVector kPosture = (Vector6d() << 0.3, 0.4, -0.5, 0.6, 0.7, -0.8).finished();
const JointVector kCompliance =
    (Vector6d() << 1 / 4.0, 1 / 3.2, 1 / 2.6, 1 / 0.42, 1 / 0.23, 1 / 0.089).finished() * 1e-6;

robot::GravityLoad weightOf(const robot::Robot& arm) {
  robot::GravityLoad weight;
  weight.bodies = arm.bodies;
  weight.gravity_in_base = {0, 0, -9.80665};
  weight.links_known = true;
  return weight;
}

/// The hanging load as a dead force at a point of the flange body that stands at `hook_at_zero` at zero.
robot::Wrench hanging(const robot::ArmPosture& posture, const Eigen::Vector3d& hook_at_zero, double newton) {
  return {posture.motion.back() * hook_at_zero, {0, 0, -newton}, Eigen::Vector3d::Zero()};
}

TEST(JointTorque, SameWhereverTheWrenchIsReduced) {
  const robot::Robot arm = exampleArm();
  const robot::ArmPosture posture = robot::postureAt(arm, kPosture);
  const robot::Wrench wrench{{1.2, 0.3, 1.7}, {300, -200, -1500}, {40, 50, -60}};
  const JointVector there = robot::jointTorque(arm, posture, wrench);
  const JointVector elsewhere = robot::jointTorque(arm, posture, wrench.about({-3.0, 2.0, 5.0}));
  EXPECT_LT((there - elsewhere).norm(), 1e-9 * there.norm());  // rounding only
}

TEST(JointTorque, AHandCase) {
  // Straight out at zero: 1 kN down at the flange, 1.585 m ahead of axis 2, 1.995 - 1.695 = 0.3 m ahead of axis 5.
  const robot::Robot arm = exampleArm();
  const JointVector torque = robot::jointTorque(arm, robot::postureAt(arm, JointVector::Zero(6)),
                                                {{1.995, 0, 2.31}, {0, 0, -1000}, {0, 0, 0}});
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
  JointVector sum = JointVector::Zero(6);
  for (std::size_t body = 1; body <= 6; ++body) {
    const robot::Wrench pull{posture.motion[body] * weight.bodies[body].com_in_base_at_zero,
                             weight.bodies[body].mass_kg * weight.gravity_in_base, Eigen::Vector3d::Zero()};
    JointVector one = robot::jointTorque(arm, posture, pull);
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
  const JointMatrix stiffness =
      robot::geometricStiffness(axes, load) + robot::geometricStiffness(axes, posture, weight);
  JointMatrix numeric(6, 6);
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 6; ++k) {
    JointVector sides[2];
    for (int side = 0; side < 2; ++side) {
      const robot::ArmPosture moved =
          robot::postureAt(arm, kPosture + (side ? 1 : -1) * kStep * JointVector::Unit(6, k));
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
    JointVector q = kPosture;
    for (int i = 0; i < 50; ++i) {
      const robot::ArmPosture posture = robot::postureAt(arm, q);
      q = kPosture + kCompliance.cwiseProduct(robot::weightTorque(arm, posture, weight) +
                                              robot::jointTorque(arm, posture, hanging(posture, hook, newton)));
    }
    return q;
  };
  const JointVector unloaded = settle(0.0);
  const robot::ArmPosture posture = robot::postureAt(arm, unloaded);
  const auto errors = [&](double newton) {
    const JointVector turn = settle(newton) - unloaded;
    const robot::Wrench load = hanging(posture, hook, newton);
    const JointVector torque = robot::jointTorque(arm, posture, load);
    const robot::ArmAxes axes = robot::axesAt(arm, posture);
    const JointMatrix change = robot::geometricStiffness(axes, load) + robot::geometricStiffness(axes, posture, weight);
    const JointVector neglected = kCompliance.cwiseProduct(torque);
    const JointVector included = kCompliance.cwiseProduct(
        (JointMatrix::Identity(6, 6) - change * kCompliance.asDiagonal().toDenseMatrix()).inverse() * torque);
    return std::pair{(turn - neglected).norm() / turn.norm(), (turn - included).norm() / turn.norm()};
  };
  const auto [neglected, included] = errors(1500.0);
  EXPECT_GT(neglected, 1e-3);
  EXPECT_LT(included, 1e-4);  // what is left is of the order of the square of the turning, 1e-3 rad
}

// Machines of any number of joints, by the tests' own chain of joint frames.

robot::GravityLoad weightOf(const ChainArm& chain) { return weightOf(chain.robot()); }

/// A load on the flange: its point there, force and moment as they keep their direction.
struct FlangeForce {
  Eigen::Vector3d point_in_flange{0.05, -0.1, 0.2}, force{120.0, -80.0, -300.0}, moment{10.0, -25.0, 15.0};

  robot::Wrench at(const ChainArm& chain, const JointVector& q) const {
    return {chain.flangeAt(q) * point_in_flange, force, moment};
  }
};

TEST(JointTorque, IsTheWorkOfAVirtualTurn) {
  const FlangeForce load;
  Noise noise(6);
  for (const ChainArm& exact : chainsOfAllSizes()) {
    const ChainArm chain = exact.disturbed(noise, 0.05, 0.2);
    const robot::Robot arm = chain.robot();
    for (int k = 0; k < 20; ++k) {
      const JointVector q = somePosture(noise, chain);
      const JointVector torque = robot::jointTorque(arm, robot::postureAt(arm, q), load.at(chain, q));
      ASSERT_EQ(torque.size(), chain.joints());
      JointVector work(chain.joints());
      constexpr double kStep = 1e-5;
      for (int j = 0; j < chain.joints(); ++j) {
        const JointVector step = kStep * JointVector::Unit(chain.joints(), j);
        const Eigen::Isometry3d ahead = chain.flangeAt(q + step), behind = chain.flangeAt(q - step);
        const Eigen::AngleAxisd turn(ahead.linear() * behind.linear().transpose());
        const Eigen::Vector3d moved = ahead * load.point_in_flange - behind * load.point_in_flange;
        work[j] = (load.force.dot(moved) + load.moment.dot(turn.angle() * turn.axis())) / (2 * kStep);
      }
      // 300 N times metres: the step's square, 1e-10, and rounding of 1e-16 m over 2e-5 rad.
      EXPECT_LT((torque - work).cwiseAbs().maxCoeff(), 1e-6) << chain.joints();
    }
  }
}

TEST(GravityLoad, IsTheWeightOfTheChain) {
  Noise noise(7);
  for (const ChainArm& exact : chainsOfAllSizes()) {
    const ChainArm chain = exact.disturbed(noise, 0.05, 0.2);
    const robot::Robot arm = chain.robot();
    for (int k = 0; k < 20; ++k) {
      const JointVector q = somePosture(noise, chain), expected = chain.weightTorque(q);
      const JointVector torque = robot::weightTorque(arm, robot::postureAt(arm, q), weightOf(chain));
      EXPECT_LT((torque - expected).norm(), 1e-12 * expected.norm()) << chain.joints();  // rounding
    }
  }
}

TEST(GravityLoad, OfAToolIsCarriedByTheLastBody) {
  for (const ChainArm& chain : chainsOfAllSizes()) {
    const robot::Robot arm = chain.robot();
    const robot::GravityLoad weight = robot::gravityLoad(arm, robot::Tool{30.0, {0.0, 0.1, 0.2}}, {0, 0, -9.80665}, arm,
                                                         Eigen::Isometry3d::Identity());
    EXPECT_TRUE(weight.links_known);
    Noise noise(8);
    const JointVector q = somePosture(noise, chain);
    const JointVector expected =
        chain.weightTorque(q) + chain.torqueOf(q, chain.joints(), chain.flangeAt(q) * Eigen::Vector3d(0.0, 0.1, 0.2),
                                               {0, 0, -30.0 * 9.80665}, Eigen::Vector3d::Zero());
    EXPECT_LT((robot::weightTorque(arm, robot::postureAt(arm, q), weight) - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST(GravitySag, IsWhereSpringsAndWeightBalance) {
  Noise noise(9);
  for (const ChainArm& chain : chainsOfAllSizes()) {
    const JointVector compliance = JointVector::LinSpaced(chain.joints(), 2e-7, 9e-7);
    const JointVector q = somePosture(noise, chain);
    const JointVector sagged = robot::saggedAngles(chain.robot(), q, weightOf(chain), compliance);
    // Three steps of a fixed point that contracts a hundredfold: of 1e-2 rad nothing above 1e-8 is left.
    EXPECT_LT((sagged - q - compliance.cwiseProduct(chain.weightTorque(sagged))).norm(), 1e-8) << chain.joints();
    EXPECT_GT((sagged - q).norm(), 1e-6);
  }
}

TEST(GeometricStiffness, IsTheDerivativeOfTheChainsTorques) {
  const FlangeForce load;
  Noise noise(10);
  for (const ChainArm& exact : chainsOfAllSizes()) {
    const ChainArm chain = exact.disturbed(noise, 0.05, 0.2);
    const robot::Robot arm = chain.robot();
    for (int k = 0; k < 20; ++k) {
      const JointVector q = somePosture(noise, chain);
      const robot::ArmPosture posture = robot::postureAt(arm, q);
      const robot::ArmAxes axes = robot::axesAt(arm, posture);
      const JointMatrix stiffness = robot::geometricStiffness(axes, load.at(chain, q)) +
                                    robot::geometricStiffness(axes, posture, weightOf(chain));
      JointMatrix numeric(chain.joints(), chain.joints());
      constexpr double kStep = 1e-5;
      const auto torqueAt = [&](const JointVector& at) -> JointVector {
        const robot::Wrench wrench = load.at(chain, at);
        return chain.torqueOf(at, chain.joints(), wrench.point, wrench.force, wrench.moment) + chain.weightTorque(at);
      };
      for (int j = 0; j < chain.joints(); ++j) {
        const JointVector step = kStep * JointVector::Unit(chain.joints(), j);
        numeric.col(j) = (torqueAt(q + step) - torqueAt(q - step)) / (2 * kStep);
      }
      // The step's square, and rounding of the torques over it: both about 1e-10 of the largest entry.
      EXPECT_LT((stiffness - numeric).cwiseAbs().maxCoeff(), 1e-8 * stiffness.cwiseAbs().maxCoeff()) << chain.joints();
    }
  }
}

}  // namespace statics_test
}  // namespace stiffscope
