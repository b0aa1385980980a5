#include "core/robot/balancer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/robot/geometric_stiffness.h"
#include "core/robot/gravity_load.h"

namespace stiffscope::robot {
namespace {

using Eigen::Vector3d;

metrology::Line line(const Vector3d& point, const Vector3d& direction) {
  metrology::Line line;
  line.point = point;
  line.direction = direction.normalized();
  return line;
}

/// Skew on purpose: no two axes are parallel or meet.
ArmAxes skewAxes() {
  ArmAxes axes;
  axes.push_back(line({0.02, -0.01, 0.0}, {0.05, 0.02, 1.0}));
  axes.push_back(line({0.35, 0.03, 0.67}, {0.1, 1.0, -0.04}));
  axes.push_back(line({0.36, -0.02, 1.8}, {-0.07, 1.0, 0.2}));
  axes.push_back(line({1.0, 0.01, 1.78}, {1.0, 0.3, 0.1}));
  return axes;
}

ArmPosture postureOf(const ArmAxes& axes, const JointVector& q) {
  return postureAt(axes, q, Eigen::Isometry3d::Identity());
}

/// Each axis carried by the body below it.
ArmAxes placedAt(const ArmAxes& axes_at_zero, const ArmPosture& posture) {
  ArmAxes placed = axes_at_zero;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    placed[i].point = posture.motion[i] * axes_at_zero[i].point;
    placed[i].direction = posture.motion[i].linear() * axes_at_zero[i].direction;
  }
  return placed;
}

constexpr double kPi = std::numbers::pi, kAtmosphere = 101325.0;

/// Work stored, integrated by hand from the laws: none of the code's forces is in it.
double energyOf(const Balancer& balancer, double length) {
  if (const auto* spring = std::get_if<SpringLaw>(&balancer.law)) {
    const double more = length - spring->length_m;
    return spring->tension_n * more + spring->rate_n_per_m * more * more / 2.0;
  }
  const GasLaw& gas = std::get<GasLaw>(balancer.law);
  const double volume = gas.volume_m3 + (gas.pushes ? 1.0 : -1.0) * gas.area_m2 * (length - gas.length_m);
  const double absolute = gas.pressure_pa + kAtmosphere, n = gas.exponent;
  const double of_gas = n == 1.0 ? -absolute * gas.volume_m3 * std::log(volume)
                                 : absolute * std::pow(gas.volume_m3, n) * std::pow(volume, 1.0 - n) / (n - 1.0);
  return of_gas + kAtmosphere * volume;
}

std::vector<Balancer> balancers() {
  const BalancerEnd column{1, {-0.3, 0.05, 0.5}}, upper_arm{2, {0.3, 0.1, 1.2}};
  const BalancerEnd base{0, {-0.4, 0.1, 0.3}}, forearm{4, {1.1, -0.1, 1.9}};
  const SpringLaw spring{40e3, 6e3, 0.8};
  const GasLaw pulls{140e5, 1.4e-3, 3e-3, 0.9, 1.0, false}, pushes{80e5, 1e-3, 4e-3, 0.9, 1.3, true};
  return {{spring, column, upper_arm, {}, {}},
          {spring, forearm, base, {}, {}},
          {pulls, column, upper_arm, {}, {}},
          {pushes, upper_arm, base, {}, {}},
          {pushes, base, forearm, {}, {}}};
}

JointVector someAngles() {
  JointVector q(4);
  q << 0.4, 0.7, -0.5, 0.9;
  return q;
}

TEST(Balancer, TorqueIsMinusTheSlopeOfTheStoredEnergy) {
  const ArmAxes axes = skewAxes();
  const JointVector q = someAngles();
  const auto all = balancers();
  for (std::size_t one = 0; one < all.size(); ++one) {
    const ArmPosture posture = postureOf(axes, q);
    const JointVector torque = balancerTorque(placedAt(axes, posture), posture, all[one]);
    EXPECT_GT(torque.norm(), 100.0);
    for (Eigen::Index i = 0; i < 4; ++i) {
      const double step = 1e-5;
      const auto energy = [&](double by) {
        JointVector there = q;
        there[i] += by;
        return energyOf(all[one], lengthAt(all[one], postureOf(axes, there)));
      };
      EXPECT_NEAR(torque[i], -(energy(step) - energy(-step)) / (2 * step), 1e-3) << one << " axis " << i;
    }
  }
}

TEST(Balancer, StiffnessIsTheSlopeOfTheTorque) {
  const ArmAxes axes = skewAxes();
  const JointVector q = someAngles();
  const auto all = balancers();
  for (std::size_t one = 0; one < all.size(); ++one) {
    const ArmPosture posture = postureOf(axes, q);
    const JointMatrix stiffness = balancerStiffness(placedAt(axes, posture), posture, all[one]);
    EXPECT_GT(stiffness.norm(), 100.0);
    for (Eigen::Index i = 0; i < 4; ++i) {
      const double step = 1e-5;
      const auto torque = [&](double by) {
        JointVector there = q;
        there[i] += by;
        const ArmPosture moved = postureOf(axes, there);
        return balancerTorque(placedAt(axes, moved), moved, all[one]);
      };
      const JointVector slope = (torque(step) - torque(-step)) / (2 * step);
      EXPECT_LT((stiffness.col(i) - slope).norm(), 1e-4) << one << " axis " << i;
    }
  }
}

/// Ends at a and b from the joint, an angle apart: l^2 = a^2 + b^2 - 2 a b cos, lever a b sin / l.
TEST(Balancer, TorqueOfTwoBarsByTheLawOfCosines) {
  ArmAxes axes;
  axes.push_back(line({0, 0, 0}, {0, 0, 1}));
  const double a = 0.4, b = 0.9, turn = kPi / 3;
  const Balancer spring{SpringLaw{20e3, 5e3, 0.7}, {0, {a, 0, 0}}, {1, {b, 0, 0}}, {}, {}};
  JointVector q(1);
  q << turn;
  const ArmPosture posture = postureOf(axes, q);
  const double length = std::sqrt(a * a + b * b - 2 * a * b * std::cos(turn));
  EXPECT_NEAR(lengthAt(spring, posture), length, 1e-12);
  const double tension = 5e3 + 20e3 * (length - 0.7);
  EXPECT_NEAR(balancerTorque(placedAt(axes, posture), posture, spring)[0], -tension * a * b * std::sin(turn) / length,
              1e-9);
}

TEST(Balancer, GasOfMakersData) {
  // 100 bar on 10 cm2 hold 10 kN; 1 l more than 2 l leaves 2/3 of the absolute pressure.
  const Balancer pushes{GasLaw{100e5, 1e-3, 2e-3, 0.5, 1.0, true}, {}, {}, {}, {}};
  EXPECT_NEAR(tensionAt(pushes, 0.5).force_n, -10e3, 1e-9);
  EXPECT_NEAR(tensionAt(pushes, 1.5).force_n, -(10101325.0 * 2 / 3 - 101325.0) * 1e-3, 1e-6);
  const Balancer pulls{GasLaw{100e5, 1e-3, 2e-3, 0.5, 1.0, false}, {}, {}, {}, {}};
  EXPECT_NEAR(tensionAt(pulls, 1.5).force_n, (10101325.0 * 2 - 101325.0) * 1e-3, 1e-6);
  EXPECT_FALSE(withinStroke(pulls, 2.5));  // no volume left
  EXPECT_TRUE(withinStroke(pulls, 2.4));
}

TEST(Balancer, StrokeHasTwoEnds) {
  const Balancer spring{SpringLaw{20e3, 5e3, 0.7}, {}, {}, 0.6, 0.9};
  EXPECT_FALSE(withinStroke(spring, 0.59));
  EXPECT_TRUE(withinStroke(spring, 0.75));
  EXPECT_FALSE(withinStroke(spring, 0.91));
}

/// Three joints turn the four skew axes: the third one's turn goes back along the second's, as by a parallelogram's
/// rods.
Robot coupledArm() {
  Robot robot;
  robot.axes_in_base_at_zero = skewAxes();
  Couplings couplings;
  couplings.turns = JointMatrix::Zero(4, 3);
  couplings.turns(0, 0) = couplings.turns(1, 1) = couplings.turns(2, 2) = 1.0;
  couplings.turns(2, 1) = -1.0;
  couplings.turns(3, 2) = 0.5;
  couplings.own_axis = {0, 1, 2};
  couplings.own_joint = {0, 1, 2, -1};
  robot.axes_in_base_at_zero.couplings = std::make_shared<const Couplings>(couplings);
  robot.bodies.resize(5);
  robot.balancers = balancers();
  return robot;
}

GravityLoad loadOf(const Robot& robot) {
  return gravityLoad(robot, std::nullopt, Vector3d(0, 0, -9.81), robot, Eigen::Isometry3d::Identity());
}

TEST(Balancer, OfCoupledJointsIsTheSlopeByTheJoints) {
  const Robot robot = coupledArm();
  const GravityLoad weight = loadOf(robot);
  ASSERT_TRUE(weight.any());
  EXPECT_FALSE(weight.links_known);  // no balancer stands in for masses
  const JointVector q = (JointVector(3) << 0.4, 0.7, -0.5).finished();
  const double step = 1e-5;
  const auto energy = [&](const JointVector& at) {
    double sum = 0.0;
    for (const Balancer& one : robot.balancers) sum += energyOf(one, lengthAt(one, postureAt(robot, at)));
    return sum;
  };
  const auto torqueAt = [&](const JointVector& at) { return weightTorque(robot, postureAt(robot, at), weight); };
  const ArmPosture posture = postureAt(robot, q);
  const JointVector torque = torqueAt(q);
  const JointMatrix stiffness = geometricStiffness(axesAt(robot, posture), posture, weight);
  ASSERT_EQ(torque.size(), 3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const JointVector by = step * JointVector::Unit(3, i);
    // Energies of some 1e5 J are rounded to 1e-11, over 2e-5.
    EXPECT_NEAR(torque[i], -(energy(q + by) - energy(q - by)) / (2 * step), 1e-2) << i;
    EXPECT_LT((stiffness.col(i) - (torqueAt(q + by) - torqueAt(q - by)) / (2 * step)).norm(), 1e-3) << i;
    EXPECT_GT(stiffness.col(i).norm(), 100.0);
  }
}

/// What a body carries from there outwards turns its axis as the torque has it; beyond both ends nothing is carried.
TEST(Balancer, BodiesCarryWhatTheJointsHold) {
  const ArmAxes axes = skewAxes();
  const ArmPosture posture = postureOf(axes, someAngles());
  const ArmAxes placed = placedAt(axes, posture);
  for (const Balancer& one : balancers()) {
    PerBody<Wrench> from_body(5);
    addBalancerForces(one, posture, from_body);
    const JointVector torque = balancerTorque(placed, posture, one);
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const double moment = placed[axis].direction.dot(from_body[axis + 1].about(placed[axis].point).moment);
      EXPECT_NEAR(moment, torque[static_cast<Eigen::Index>(axis)], 1e-9);
    }
    const int inner = std::min(one.from.body, one.to.body), outer = std::max(one.from.body, one.to.body);
    for (int body = 0; body <= 4; ++body) {
      const bool between = body > inner && body <= outer;
      EXPECT_EQ(from_body[static_cast<std::size_t>(body)].force.norm() > 0.0, between) << body;
    }
  }
}

TEST(Balancer, StandsInTheFrameOfTheWeight) {
  const Robot robot = coupledArm();
  const Eigen::Isometry3d moved(Eigen::Translation3d(0.3, -0.2, 0.1) *
                                Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()));
  const GravityLoad weight = gravityLoad(robot, std::nullopt, Vector3d(0, 0, -9.81), robot, moved);
  const JointVector q = (JointVector(3) << 0.4, 0.7, -0.5).finished();
  Robot there = robot;
  for (metrology::Line& axis : there.axes_in_base_at_zero) axis = {moved * axis.point, moved.linear() * axis.direction};
  const JointVector here = weightTorque(robot, postureAt(robot, q), loadOf(robot));
  EXPECT_LT((weightTorque(there, postureAt(there, q), weight) - here).norm(), 1e-9 * here.norm());
}

TEST(Balancer, IsNoMassThatCouldBeScaled) {
  Robot robot = coupledArm();
  for (std::size_t body = 1; body < 5; ++body) robot.bodies[body] = {50.0, {0.3 * static_cast<double>(body), 0, 1.0}};
  const JointVector q = (JointVector(3) << 0.4, 0.7, -0.5).finished();
  const auto torqueOf = [&](const Robot& of) { return weightTorque(of, postureAt(of, q), loadOf(of)); };
  Robot alone = robot, heavier = robot;
  alone.balancers.clear();
  scaleMasses(1.1, heavier);
  EXPECT_TRUE(loadOf(robot).links_known);
  EXPECT_LT((torqueOf(heavier) - torqueOf(robot) - 0.1 * torqueOf(alone)).norm(), 1e-9 * torqueOf(robot).norm());
}

TEST(Balancer, EndsTheRangeOfTheAxesByItsStroke) {
  Robot robot;
  robot.axes_in_base_at_zero.push_back(line({0, 0, 0}, {0, 0, 1}));
  const double a = 0.4, b = 0.9;
  robot.balancers = {{SpringLaw{20e3, 5e3, 0.7}, {0, {a, 0, 0}}, {1, {b, 0, 0}}, {}, 1.0}};
  // At 90 deg its length is sqrt(a^2 + b^2) = 0.985 m, at 100 deg 1.045 m.
  EXPECT_TRUE(withinAxisLimits(robot, JointVector::Constant(1, kPi / 2)));
  EXPECT_FALSE(withinAxisLimits(robot, JointVector::Constant(1, kPi / 1.8)));
}

}  // namespace
}  // namespace stiffscope::robot
