#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/effects/all.h"
#include "core/effects/elastic_arm.h"
#include "core/preparation/station_course.h"
#include "tests/fixtures/chain_arm.h"

// Each effect's displacement field against a case worked by hand, on the tests' own kinematics.

namespace stiffscope {
namespace effects_test {

constexpr double kRounding = 1e-9;  // m per unit parameter times lever and load: far below a micrometre of the field

/// The model of an effect with these words in its shape, the first without any.
effects::EffectModel modelOf(const effects::EffectRecord& record, const std::string& shape = "") {
  const auto models = effects::modelsOf(record, {.joints = 6, .targets = {"P1", "P2"}});
  for (const effects::EffectModel& model : models) {
    if (model.shape.find(shape) != std::string::npos) return model;
  }
  throw std::invalid_argument(shape);
}

/// A state of the example arm with a load on the tool, no own weight.
struct Bench {
  ChainArm chain = exampleChain();
  frames::LoadingGeometry geometry;
  effects::LinearizationPoint at{6};
  JointVector q = degrees(10, 20, -15, 40, 50, -30);
  robot::Wrench load{{2.0, 0.1, 1.9}, {300.0, -500.0, -900.0}, {40.0, 20.0, -10.0}};
  std::vector<Eigen::Vector3d> points{{2.1, 0.3, 1.8}, {2.0, -0.2, 2.1}};

  Bench() {
    geometry.arm = chain.robot();
    at.compliance = exampleCompliance();
    at.targets = 2;
    at.largest_force = load.force.norm();
  }
  effects::ArmState state(double share) const {
    effects::ArmState one = effects::stateAt(geometry, q, JointVector::Zero(6));
    one.load = {load.point, share * load.force, share * load.moment};
    one.load_torque = chain.torqueOf(q, 6, load.point, one.load.force, one.load.moment);
    one.loaded = share > 0.05;
    one.points = points;
    one.targets = {0, 1};
    return one;
  }
  effects::PostureStates outAndBack() const { return {state(0.0), state(0.5), state(1.0), state(0.0)}; }
  Eigen::Vector3d jointOrigin(int j) const { return chain.framesAt(q)[static_cast<std::size_t>(j)].translation(); }
  Eigen::Vector3d jointAxis(int j) const {
    return chain.framesAt(q)[static_cast<std::size_t>(j)].linear() * chain.axis[static_cast<std::size_t>(j)];
  }
  Eigen::Vector3d momentAt(const Eigen::Vector3d& x) const { return load.moment + (load.point - x).cross(load.force); }
};

/// The small form of a posture gives back every number that drives an effect.
TEST(CompactPosture, GivesItsStatesBack) {
  const Bench bench;
  effects::PostureStates states = bench.outAndBack();
  for (std::size_t s = 0; s < states.size(); ++s) {
    states[s].pose = 7, states[s].step = static_cast<int>(s), states[s].time_s = 10.0 * static_cast<double>(s);
  }
  const effects::CompactPosture compact(states);
  EXPECT_EQ(compact.pose(), 7);
  const effects::PostureStates back = compact.states(bench.geometry);
  ASSERT_EQ(back.size(), states.size());
  for (std::size_t s = 0; s < states.size(); ++s) {
    const effects::ArmState &was = states[s], &is = back[s];
    EXPECT_EQ(is.pose, was.pose);
    EXPECT_EQ(is.step, was.step);
    EXPECT_EQ(is.time_s, was.time_s);
    EXPECT_EQ(is.loaded, was.loaded);
    EXPECT_EQ(is.q, was.q);
    EXPECT_EQ(is.turned, was.turned);
    EXPECT_EQ(is.load.point, was.load.point);
    EXPECT_EQ(is.load.force, was.load.force);
    EXPECT_EQ(is.load.moment, was.load.moment);
    EXPECT_EQ(is.load_torque, was.load_torque);
    EXPECT_EQ(is.weight_torque, was.weight_torque);
    EXPECT_EQ(is.targets, was.targets);
    EXPECT_EQ(is.points, was.points);
    EXPECT_EQ(is.flange.matrix(), was.flange.matrix());
    for (std::size_t j = 0; j < 6; ++j) {
      EXPECT_EQ(is.axes[j].point, was.axes[j].point);
      EXPECT_EQ(is.axes[j].direction, was.axes[j].direction);
    }
  }
}

TEST(BearingTilt, TurnsAcrossTheAxisByTheMomentThere) {
  const Bench bench;
  const Eigen::MatrixXd field = modelOf(effects::bearingTilt()).columns(bench.at, bench.outAndBack(), 2);
  for (int j = 0; j < 6; ++j) {
    const Eigen::Vector3d origin = bench.jointOrigin(j), axis = bench.jointAxis(j), moment = bench.momentAt(origin);
    const Eigen::Vector3d across = moment - axis * axis.dot(moment);
    for (int t = 0; t < 2; ++t) {
      const Eigen::Vector3d expected = across.cross(bench.points[static_cast<std::size_t>(t)] - origin);
      const Eigen::Vector3d found = field.block<3, 1>(3 * t, j);
      EXPECT_LT((found - expected).norm(), kRounding * expected.norm() + kRounding) << j;
    }
  }
}

/// On a rail along R0's x, of postures at 1, 2 and 3 m.
Bench onRail() {
  Bench bench;
  bench.at.rail_in_base = Eigen::Vector3d::UnitX();
  bench.at.rail.mean = 2.0;
  bench.at.rail.scale = 1.0;
  bench.at.rail.mean_square = 2.0 / 3.0;
  return bench;
}

effects::EffectModel railModel() {
  return effects::modelsOf(effects::railBending(), {.joints = 6, .targets = {"P1", "P2"}, .on_rail = true}).front();
}

// At 2.5 m x is 0.5 and x^2 less its mean 0.25 - 2/3. The foot is R0's origin.
TEST(RailBending, ShiftsAndTurnsTheFootByItsLoadAndThePosition) {
  const Bench bench = onRail();
  effects::PostureStates posture = bench.outAndBack();
  for (effects::ArmState& state : posture) state.carriage = 2.5;
  const effects::EffectModel model = railModel();
  const Eigen::MatrixXd field = model.columns(bench.at, posture, 2);
  ASSERT_EQ(field.cols(), 16);
  const Eigen::Vector3d force = bench.load.force, moment = bench.momentAt(Eigen::Vector3d::Zero());
  const double linear = 0.5, square = 0.25 - 2.0 / 3.0;
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  for (int t = 0; t < 2; ++t) {
    const Eigen::Vector3d point = bench.points[static_cast<std::size_t>(t)];
    const auto expect = [&](int column, const Eigen::Vector3d& expected) {
      const Eigen::Vector3d found = field.block<3, 1>(3 * t, column);
      EXPECT_LT((found - expected).norm(), kRounding) << column;
    };
    expect(2, linear * force.z() * z);                // shift off the rail by position
    expect(3, square * force.z() * z);                // by its square
    expect(6, linear * moment.y() * y.cross(point));  // rocking across the rail
    expect(9, square * moment.z() * z.cross(point));  // turn on the rail
    const Eigen::Vector3d coupled = force.z() * y.cross(point) + moment.y() * z;
    expect(10, coupled);
    expect(11, linear * coupled);
    expect(12, square * coupled);
  }
  // Where nothing says where the carriage stands the mean over the positions is left.
  for (effects::ArmState& state : posture) state.carriage = campaign::kNotGiven;
  const Eigen::MatrixXd unknown = model.columns(bench.at, posture, 2);
  EXPECT_EQ(unknown.leftCols(10).norm(), 0.0);
  EXPECT_EQ((unknown.col(10) - field.col(10)).norm(), 0.0);
}

// Reflectors at (2, 0, 1.5) m in the rail's sweep under 8 kN of own weight: a shift off the rail that grows with the
// position by 1e-9 m/N is 8 um a metre of the line's slope. What it shifts at 2.5 m is taken off again in full.
TEST(RailBending, WhatTheRailsLineHasTakenInIsNoShift) {
  Bench bench = onRail();
  bench.at.rail.line_by_x = 1.0;
  bench.at.rail.weight_at_sweep = {Eigen::Vector3d::Zero(), {0.0, 0.0, -8000.0}, Eigen::Vector3d::Zero()};
  bench.at.rail.reflectors_at_sweep = {2.0, 0.0, 1.5};
  effects::PostureStates posture = bench.outAndBack();
  for (effects::ArmState& state : posture) {
    state.carriage = 2.5;
    state.load = {};
    state.weight_from_body.assign(state.weight_from_body.size(), bench.at.rail.weight_at_sweep);
  }
  const effects::EffectModel model = railModel();
  EXPECT_LT(model.columns(bench.at, posture, 0).col(2).norm(), kRounding);
  // Coupled, that weight turns the arm as well: reflectors elsewhere than in the sweep move.
  const Eigen::MatrixXd coupled = model.columns(bench.at, posture, 0);
  const Eigen::Vector3d turned =
      0.5 * -8000.0 * Eigen::Vector3d::UnitY().cross(bench.points[0] - Eigen::Vector3d(2.0, 0.0, 1.5));
  EXPECT_LT((coupled.block<3, 1>(0, 11) - turned).norm(), kRounding * turned.norm());
}

// By how much the loaded arm at rest moves with a small size of each parameter, against the columns.
TEST(RailBending, ItsColumnsAreTheDerivativesOfTheElasticArm) {
  const Bench bench = onRail();
  effects::PostureStates posture = bench.outAndBack();
  for (effects::ArmState& state : posture) state.carriage = 2.7;
  const effects::EffectModel model = railModel();
  const JointVector rigid = JointVector::Zero(6);
  const effects::ElasticArm without(bench.geometry, rigid, bench.at, {});
  const Eigen::Isometry3d plain = *without.toolMotion(posture, 2, nullptr);
  const effects::ToolLoad load{plain.inverse() * bench.load.point, bench.load.force, bench.load.moment};
  const Eigen::MatrixXd field = model.columns(bench.at, posture, 2);
  constexpr double kSize = 1e-10;  // moves by less than a micrometre: the square of it is below 1e-12 m
  for (Eigen::Index k = 0; k < field.cols(); ++k) {
    const effects::ElasticArm with(bench.geometry, rigid, bench.at, {{&model, kSize * Eigen::VectorXd::Unit(16, k)}});
    const Eigen::Isometry3d moved = *with.toolMotion(posture, 2, &load);
    for (int t = 0; t < 2; ++t) {
      const Eigen::Vector3d at_zero = plain.inverse() * bench.points[static_cast<std::size_t>(t)];
      const Eigen::Vector3d by = (moved * at_zero - plain * at_zero) / kSize;
      EXPECT_LT((by - field.block<3, 1>(3 * t, k)).norm(), 1e-3 * field.col(k).norm() + 1e-3) << k;
    }
  }
}

// With wrist axes that meet and the tilt taken at the wrist, the tilt of axis 4 has two directions: one is
// joint 5's own, driven by joint 5's own torque. A load without a moment about the other direction leaves
// nothing else.
TEST(BearingTilt, OfAxis4IsJoint5sOwnComplianceInASphericalWrist) {
  Bench bench;
  const auto frames = bench.chain.framesAt(bench.q);
  const Eigen::Vector3d wrist = frames[4].translation(), z4 = bench.jointAxis(3), z5 = bench.jointAxis(4);
  const Eigen::Vector3d other = z4.cross(z5).normalized();
  bench.geometry.arm.axes_in_base_at_zero[3].point =
      bench.chain.framesAt(JointVector::Zero(6))[4].translation();  // on axis 4: the same line
  bench.load.moment -= other * other.dot(bench.momentAt(wrist));
  const effects::PostureStates posture = bench.outAndBack();
  const Eigen::VectorXd tilt = modelOf(effects::bearingTilt()).columns(bench.at, posture, 2).col(3);
  const Eigen::VectorXd own = effects::byEachJoint(posture[2], posture[2].load_torque).col(4);
  EXPECT_LT((tilt - own).norm(), 1e-9 * own.norm());
}

TEST(LinkCompliance, IsACantileverAtItsTip) {
  Bench bench;
  bench.q.setZero();  // link 2 stands upright, 1.12 m; its tip is joint 3
  const Eigen::Vector3d tip = bench.jointOrigin(2);
  bench.points = {tip, tip + Eigen::Vector3d(0, 0, 1)};
  bench.load = {tip, {1000.0, 0, 0}, {0, 0, 50.0}};
  const Eigen::MatrixXd field = modelOf(effects::linkCompliance()).columns(bench.at, bench.outAndBack(), 2);
  const double length = 1.12;
  const Eigen::Vector3d bend = field.block<3, 1>(0, 2), beyond = field.block<3, 1>(3, 2);
  EXPECT_NEAR(bend.x(), 1000.0 * std::pow(length, 3) / 3.0, 1e-6);           // F L^3 / 3
  EXPECT_NEAR(beyond.x() - bend.x(), 1000.0 * length * length / 2.0, 1e-6);  // slope F L^2 / 2 over 1 m
  const Eigen::Vector3d twist = field.block<3, 1>(0, 3);
  EXPECT_LT(twist.norm(), 1e-9);  // leaves the tip where it is
}

// A section that hardly bends hardly twists; a plate that bends about one axis bends about the other. Links are each
// their own, and so are turns and shifts, whose units differ.
TEST(Alike, AreALinksTwoParametersAndAToolsTurnsAndShifts) {
  const effects::EffectModel links = modelOf(effects::linkCompliance());
  std::vector<int> of_links;
  for (const effects::EffectPart& part : links.parts) of_links.push_back(part.alike);
  EXPECT_EQ(of_links, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(links.parts.front().most.size(), 2u);
  std::vector<int> of_tool;
  for (const effects::EffectPart& part : modelOf(effects::toolCompliance()).parts) of_tool.push_back(part.alike);
  EXPECT_EQ(of_tool, (std::vector<int>{1, 1, 1, 2, 2, 2}));
  for (const effects::EffectPart& part : modelOf(effects::bearingTilt()).parts) EXPECT_EQ(part.alike, 0);
}

// A nest that gives along x of the flange only, and a slip along the pull: both by the force alone, on the
// reflector that moves; unloading takes the first back and leaves the second.
TEST(TargetMotion, FollowsTheForceInTheNest) {
  const Bench bench;
  const effects::PostureStates posture = bench.outAndBack();
  const Eigen::Matrix3d axes = posture[2].flange.linear();
  const Eigen::Vector3d along_x = axes.col(0) * axes.col(0).dot(bench.load.force) / bench.load.force.norm();
  const effects::EffectModel spring = modelOf(effects::targetMotion(), "spring of the nest"),
                             slip = modelOf(effects::targetMotion(), "along the pull");
  for (const std::size_t state : {std::size_t{1}, std::size_t{2}, std::size_t{3}}) {
    const double share = state == 1 ? 0.5 : state == 2 ? 1.0 : 0.0, most = state == 1 ? 0.5 : 1.0;
    const Eigen::MatrixXd by_spring = spring.columns(bench.at, posture, state),
                          by_slip = slip.columns(bench.at, posture, state);
    ASSERT_EQ(by_spring.cols(), 12);
    ASSERT_EQ(by_slip.cols(), 2);
    EXPECT_LT((by_spring.block<3, 1>(3, 6) - share * along_x).norm(), kRounding);  // xx of the second
    EXPECT_LT((by_slip.block<3, 1>(0, 0) - most * bench.load.force.normalized()).norm(), kRounding);
    EXPECT_TRUE(by_spring.block(0, 6, 3, 6).isZero(0.0));  // the second's leaves the first where it is
    EXPECT_EQ(by_slip.block(3, 0, 3, 1).norm(), 0.0);
  }
  EXPECT_TRUE(slip.columns(bench.at, posture, 0).isZero(0.0));
}

// An isotropic nest moves its reflector along the force, whichever way the flange is turned.
TEST(TargetMotion, IsotropicNestMovesAlongTheForce) {
  const Bench bench;
  const Eigen::MatrixXd field =
      modelOf(effects::targetMotion(), "spring of the nest").columns(bench.at, bench.outAndBack(), 2);
  const Eigen::Vector3d sum = field.block<3, 3>(0, 0).rowwise().sum();
  EXPECT_LT((sum - bench.load.force.normalized()).norm(), kRounding);
}

TEST(TargetMotion, LastingSlipStaysThroughTheReturnToZero) {
  const Bench bench;
  const effects::PostureStates posture = bench.outAndBack();
  const effects::EffectModel slip = modelOf(effects::targetMotion(), "by a slip that stays");
  EXPECT_TRUE(slip.columns(bench.at, posture, 0).isZero(0.0));
  EXPECT_TRUE(slip.columns(bench.at, posture, 3).isApprox(slip.columns(bench.at, posture, 1), kRounding));
  EXPECT_TRUE((slip.columns(bench.at, posture, 3).block<3, 3>(0, 0).isApprox(posture[3].flange.linear())));
}

// Between rounds at 0 and 10 s a bridge is 0 at both ends and largest, 10/4, in the middle; times between
// different rounds know nothing of each other.
TEST(Station, WandersLeastNextToARound) {
  preparation::StationMotion station;
  station.epochs.resize(3);
  for (std::size_t e = 0; e < 3; ++e) station.epochs[e].time_s = 10.0 * static_cast<double>(e);
  EXPECT_DOUBLE_EQ(preparation::bridgeBetweenRounds(station, 5.0, 5.0), 2.5);
  EXPECT_DOUBLE_EQ(preparation::bridgeBetweenRounds(station, 2.0, 5.0), 1.0);
  EXPECT_DOUBLE_EQ(preparation::bridgeBetweenRounds(station, 5.0, 2.0), 1.0);
  EXPECT_DOUBLE_EQ(preparation::bridgeBetweenRounds(station, 0.0, 10.0), 0.0);
  EXPECT_DOUBLE_EQ(preparation::bridgeBetweenRounds(station, 8.0, 12.0), 0.0);
  EXPECT_DOUBLE_EQ(preparation::bridgeBetweenRounds(station, campaign::kNoTime, 5.0), 0.0);
}

TEST(JointCoupling, IsReciprocal) {
  const Bench bench;
  const effects::PostureStates posture = bench.outAndBack();
  const Eigen::MatrixXd field = modelOf(effects::jointCoupling()).columns(bench.at, posture, 2);
  ASSERT_EQ(field.cols(), 15);
  const JointVector torque = posture[2].load_torque;
  JointVector turn = JointVector::Zero(6);
  turn[1] = torque[2];
  turn[2] = torque[1];
  EXPECT_LT((field.col(5) - effects::byJoints(posture[2], turn)).norm(), kRounding);  // pairs 12 13 14 15 16 23
  EXPECT_EQ(modelOf(effects::jointCoupling()).parts[5].detail, "joints 2 and 3");
}

// theta = c tau - c a * column must solve k theta + k_3 theta^3 = tau with k = 1/c, k_3 = a / c^3, and theta
// k (1 + a tau^2) = tau, where a tau^2 is about 1.
TEST(JointHardening, WholeFormsSolveTheirSprings) {
  Bench bench;
  const effects::PostureStates posture = bench.outAndBack();
  const double tau = posture[2].load_torque[1], c = bench.at.compliance[1], a = 0.9 / (tau * tau);
  bench.at.harder_by_square[1] = a;
  bench.at.harder_by_size[1] = a * std::abs(tau);
  const auto angleBy = [&](const effects::EffectModel& model) {
    return c * tau + c * a * model.angles(bench.at, posture, 2)(1, 1);
  };
  const double spring = angleBy(modelOf(effects::jointHardening(), "cubic term")) / c,
               whole = angleBy(modelOf(effects::jointHardening(), "square of the torque, to any size")) / c;
  EXPECT_NEAR(spring + a * spring * spring * spring, tau, 1e-9 * std::abs(tau));  // Newton, to rounding
  EXPECT_NEAR(whole * (1.0 + a * tau * tau), tau, 1e-9 * std::abs(tau));
  const double linear =
      c * tau +
      c * a * std::abs(tau) *
          modelOf(effects::jointHardening(), "size of the torque, to any size").angles(bench.at, posture, 2)(1, 1);
  EXPECT_NEAR(linear / c * 1.9, tau, 1e-9 * std::abs(tau));
}

TEST(JointHardening, TakesTheCubeOfTheTorque) {
  const Bench bench;
  const effects::PostureStates posture = bench.outAndBack();
  const Eigen::MatrixXd half = modelOf(effects::jointHardening()).columns(bench.at, posture, 1),
                        full = modelOf(effects::jointHardening()).columns(bench.at, posture, 2);
  EXPECT_LT((full - 8.0 * half).norm(), 1e-9 * full.norm());
  const Eigen::MatrixXd other = modelOf(effects::jointHardening(), "size of the torque").columns(bench.at, posture, 2);
  EXPECT_LT(
      (other - 4.0 * modelOf(effects::jointHardening(), "size of the torque").columns(bench.at, posture, 1)).norm(),
      1e-9 * other.norm());
}

TEST(Backlash, ChangesSideWithTheTorque) {
  Bench bench;
  bench.at.passage = 1e-3;  // sharp
  const effects::PostureStates posture = bench.outAndBack();
  const effects::JointAngles turn = modelOf(effects::backlash()).angles(bench.at, posture, 2);
  for (int j = 0; j < 6; ++j) EXPECT_NEAR(turn(j, j), posture[2].load_torque[j] > 0.0 ? 0.5 : -0.5, 1e-12);
  EXPECT_EQ(modelOf(effects::backlash()).angles(bench.at, posture, 0).norm(), 0.0);
}

TEST(Hysteresis, LagsOutAndBackByTheFriction) {
  Bench bench;
  bench.at.friction.setConstant(10.0);
  const effects::PostureStates posture = bench.outAndBack();
  const effects::JointAngles out = modelOf(effects::hysteresis()).angles(bench.at, posture, 2),
                             back = modelOf(effects::hysteresis()).angles(bench.at, posture, 3);
  for (int j = 0; j < 6; ++j) {
    const double torque = posture[2].load_torque[j];
    if (std::abs(torque) < 20.0) continue;  // sticks on the way back
    const double side = torque > 0.0 ? 1.0 : -1.0;
    EXPECT_NEAR(out(j, j), -side, 1e-12) << j;
    EXPECT_NEAR(back(j, j), side, 1e-12) << j;
  }
  EXPECT_EQ(modelOf(effects::hysteresis()).angles(bench.at, posture, 0).norm(), 0.0);
}

// One slider of friction f on a spring r k beside the joint's k. Out by tau: k theta = tau - f once r k theta
// > f. Back to nothing: the slider gives way after 2 f / (r k), or the joint stops where (1 + r) k theta holds it.
TEST(Hysteresis, ASliderOnASpringWorkedByHand) {
  Bench bench;
  const effects::PostureStates posture = bench.outAndBack();
  const double tau = std::abs(posture[2].load_torque[1]);
  for (const double share : {0.1, 0.4}) {
    const double friction = share * tau, firm = 1.0;
    bench.at.friction.setConstant(friction);
    bench.at.sticking = firm;
    const double side = posture[2].load_torque[1] > 0.0 ? 1.0 : -1.0;
    // Out, by half the load: in the grip while firm / (1 + firm) tau / 2 < f.
    const double held_at_half = std::min(friction, 0.5 * tau * firm / (1.0 + firm));
    const effects::EffectModel model = modelOf(effects::hysteresis(), "a slider");
    EXPECT_NEAR(model.angles(bench.at, posture, 1)(1, 1), -side * held_at_half / friction, 1e-12) << share;
    const double held_at_full = std::min(friction, tau * firm / (1.0 + firm));
    EXPECT_NEAR(model.angles(bench.at, posture, 2)(1, 1), -side * held_at_full / friction, 1e-12) << share;
    // Back: the slider's force falls by r times the turn (in torque) until it has turned round.
    const double turn_at_full = tau - held_at_full;
    double turn = (firm * turn_at_full - held_at_full) / (1.0 + firm);  // still gripping
    double held = held_at_full + firm * (turn - turn_at_full);
    if (held < -friction) held = -friction;
    EXPECT_NEAR(model.angles(bench.at, posture, 3)(1, 1), -side * held / friction, 1e-12) << share;
  }
}

// Far beyond all their limits, sliders hold their whole friction, however they share it; a firm grip is the
// rigid one.
TEST(Hysteresis, ManySlidersHoldTheWholeFrictionInTheEnd) {
  Bench bench;
  const effects::PostureStates posture = bench.outAndBack();
  const double tau = posture[2].load_torque[1];
  bench.at.friction.setConstant(0.01 * std::abs(tau));
  EXPECT_NEAR(std::abs(modelOf(effects::hysteresis(), "many sliders").angles(bench.at, posture, 2)(1, 1)), 1.0, 1e-12);
  bench.at.friction.setConstant(0.3 * std::abs(tau));
  bench.at.sticking = 1e7;  // a ten-millionth of the torque goes into the grip
  for (const std::size_t state : {1U, 2U, 3U}) {
    EXPECT_NEAR(modelOf(effects::hysteresis(), "a slider").angles(bench.at, posture, state)(1, 1),
                modelOf(effects::hysteresis()).angles(bench.at, posture, state)(1, 1), 1e-6);
  }
}

// k to T/7, then twice as stiff: theta = c t_1 + c/2 (tau - t_1), which is c tau less half of c times the first
// hinge.
TEST(JointHardening, AStageIsAHingeAtItsKnot) {
  Bench bench;
  const effects::PostureStates posture = bench.outAndBack();
  bench.at.largest_torque = posture[2].load_torque.cwiseAbs();
  const double tau = posture[2].load_torque[1], knot = std::abs(tau) / 7.0, c = bench.at.compliance[1];
  const effects::JointAngles angles = modelOf(effects::jointHardening(), "by stages").angles(bench.at, posture, 2);
  const double by_hand = std::copysign(c * knot + 0.5 * c * (std::abs(tau) - knot), tau);
  EXPECT_NEAR(c * tau + 0.5 * c * angles(1, 6), by_hand, 1e-15);
  EXPECT_EQ(angles(2, 6), 0.0);  // another joint's
}

// A compliance that falls in a straight line from no torque to T/4 by c/3 and stays: its integral by hand is the first
// hinge's curve less that of T/4's.
TEST(JointHardening, ASmoothCurveIsTheIntegralOfARampedCompliance) {
  Bench bench;
  const effects::PostureStates posture = bench.outAndBack();
  bench.at.largest_torque = posture[2].load_torque.cwiseAbs();
  const double tau = posture[2].load_torque[1], whole = std::abs(tau), c = bench.at.compliance[1];
  const effects::JointAngles angles = modelOf(effects::jointHardening(), "smooth curve").angles(bench.at, posture, 2);
  const double ramp = whole / 4.0, fall = c / 3.0;
  const double by_hand = std::copysign((c - 0.5 * fall) * ramp + (c - fall) * (whole - ramp), tau);
  const double slope = fall / ramp * whole;  // knots at 0, T/8, T/4, T/2: four a joint
  EXPECT_NEAR(c * tau + slope * (angles(1, 4) - angles(1, 4 + 2)), by_hand, 1e-12 * std::abs(by_hand));
  EXPECT_EQ(angles(2, 4), 0.0);  // another joint's
}

TEST(TargetMotion, SlipsOnceTheForceHasPassedItsShare) {
  const Bench bench;
  const effects::PostureStates posture = bench.outAndBack();  // loads 0, 0.5, 1, 0
  EXPECT_EQ(modelOf(effects::targetMotion(), "beyond half").columns(bench.at, posture, 1).norm(), 0.0);
  EXPECT_GT(modelOf(effects::targetMotion(), "beyond half").columns(bench.at, posture, 2).norm(), 0.0);
  EXPECT_GT(modelOf(effects::targetMotion(), "near the full").columns(bench.at, posture, 3).norm(), 0.0);  // stays
}

// A load point that is off by r changes the moment by (R r) x F: the same as the field of the moved wrench
// less the declared.
TEST(LoadPointError, IsTheMovedWrenchThroughTheSprings) {
  const Bench bench;
  const effects::PostureStates posture = bench.outAndBack();
  const Eigen::Vector3d off(0.02, -0.01, 0.03);
  const Eigen::VectorXd field = modelOf(effects::loadPointError()).columns(bench.at, posture, 2) * off;
  const Eigen::Vector3d moved = bench.load.point + posture[2].flange.linear() * off;
  const JointVector change =
      bench.chain.torqueOf(bench.q, 6, moved, bench.load.force, bench.load.moment) - posture[2].load_torque;
  const Eigen::VectorXd expected = effects::byJoints(posture[2], bench.at.compliance.cwiseProduct(change));
  EXPECT_LT((field - expected).norm(), 1e-9 * expected.norm());
}

TEST(LoadCellBias, IsInLoadedStatesOnly) {
  const Bench bench;
  const effects::PostureStates posture = bench.outAndBack();
  const effects::EffectModel model = modelOf(effects::loadCellBias());
  EXPECT_EQ(model.columns(bench.at, posture, 0).norm(), 0.0);
  EXPECT_EQ(model.columns(bench.at, posture, 3).norm(), 0.0);
  EXPECT_GT(model.columns(bench.at, posture, 1).norm(), 0.0);
  EXPECT_LT((model.columns(bench.at, posture, 1) - model.columns(bench.at, posture, 2)).norm(), kRounding);
}

// Of an arm that hangs or leans what was not weighed still pulls along gravity, wherever R0's own axes point.
TEST(LoadCellBias, WhatWasNotWeighedPullsAlongGravity) {
  Bench bench;
  bench.at.down = Eigen::Vector3d(0.6, -0.3, -0.5).normalized();
  bench.at.load_offset = {0.02, -0.05, 0.3};
  const effects::PostureStates posture = bench.outAndBack();
  const Eigen::VectorXd field = modelOf(effects::loadCellBias(), "along gravity").columns(bench.at, posture, 2).col(0);
  const Eigen::Vector3d hook = bench.load.point + posture[2].flange.linear() * bench.at.load_offset;
  const JointVector torque = bench.chain.torqueOf(bench.q, 6, hook, bench.at.down, Eigen::Vector3d::Zero());
  const Eigen::VectorXd expected = effects::byJoints(posture[2], bench.at.compliance.cwiseProduct(torque));
  EXPECT_LT((field - expected).norm(), 1e-9 * expected.norm());
}

// Every effect is nothing without a cause: no load, no own weight, no time, no sweeps apart.
TEST(EffectTable, NothingMovesWithoutACause) {
  const Bench bench;
  effects::PostureStates rest{bench.state(0.0)};
  for (const effects::EffectModel& model : effects::effectModels({.joints = 6, .targets = {"A", "B"}})) {
    const Eigen::MatrixXd field = model.columns(bench.at, rest, 0);
    EXPECT_EQ(static_cast<std::size_t>(field.cols()), model.parameters()) << effects::idOf(model.effect);
    if (model.effect == effects::Effect::gravity_compensator) continue;  // a spring pulls always
    EXPECT_EQ(field.norm(), 0.0) << effects::idOf(model.effect);
  }
}

TEST(EffectTable, ARecordIsThatOfItsLineAndNamesAllItsParameters) {
  for (std::size_t e = 0; e < effects::kEffectCount; ++e) {
    const auto effect = static_cast<effects::Effect>(e);
    const effects::EffectRecord& record = effects::recordOf(effect);
    EXPECT_EQ(record.effect, effect) << effects::kEffectIds[e];
    EXPECT_EQ(record.models == nullptr, record.nature == effects::EffectNature::geometry) << effects::kEffectIds[e];
    for (const effects::EffectModel& model : effects::modelsOf(record, {.joints = 6, .targets = {"A", "B"}})) {
      EXPECT_EQ((model.angles != nullptr) + (model.twists != nullptr) + (model.offset != nullptr), 1) << model.shape;
      for (const effects::EffectPart& part : model.parts) {
        EXPECT_TRUE(part.most.size() == 1 || part.names.size() == part.most.size()) << model.shape;
        EXPECT_TRUE(part.units.empty() || part.units.size() == part.most.size()) << model.shape;
      }
    }
  }
}

// An ElasticArm moves bodies and joints only.
TEST(EffectTable, WhatTheMachineDoesTurnsJointsOrMovesBodies) {
  for (const effects::EffectModel& model : effects::effectModels({.joints = 6, .targets = {"A", "B"}})) {
    if (effects::natureOf(model.effect) != effects::EffectNature::machine) continue;
    EXPECT_EQ(model.offset, nullptr) << effects::idOf(model.effect);
  }
}

}  // namespace effects_test
}  // namespace stiffscope
