#include <cmath>
#include "core/simulation/gears.h"
#include "core/simulation/instruments.h"
#include "core/simulation/postures.h"
#include "core/simulation/rotation.h"
#include "core/simulation/spec.h"
#include "tests/fixtures/simulation_fixture.h"

namespace stiffscope {

using namespace simulation;
using namespace simulation_test;
using Eigen::Vector3d;

namespace unloaded_day_test {

JointVector deg(double a, double b, double c, double d, double e, double f) {
  return kDeg * (Vector6d() << a, b, c, d, e, f).finished();
}

/// A rigid arm without weight and four postures of it: nothing that a day without a load could show.
SimulationSpec rigidDay() {
  SimulationSpec spec = armSpec();
  for (JointStiffness& joint : spec.machine.joints) joint = {};
  spec.unloaded_repeats = 2;
  for (const JointVector& q : {posture(), deg(-30, 40, 10, -60, 35, 90), deg(60, -20, -50, 100, -70, 20), posture()}) {
    spec.postures.push_back({q, {}});
  }
  return spec;
}

campaign::Campaign dayOf(const SimulationSpec& spec) { return measureWithoutNoise(buildMachine(spec), spec); }

/// Where a rigid nominal arm at true angles q shows a point of its flange to the tracker.
Vector3d shownAt(const SimulationSpec& spec, const JointVector& q, const Vector3d& on_flange) {
  return spec.tracker.base_from_tracker.inverse() * (nominalFlange(spec.nominal, q) * on_flange);
}

/// Every reading of the day against the rigid arm turned to trueAngles(posture).
template <class TrueAngles>
double farthestFrom(const SimulationSpec& spec, const TrueAngles& trueAngles) {
  double most = 0.0;
  const campaign::Campaign day = dayOf(spec);
  for (const campaign::LoadingReading& one : day.loading->rows) {
    const Vector3d there =
        shownAt(spec, trueAngles(one.pose), spec.targets[static_cast<std::size_t>(one.target)].position_in_flange);
    most = std::max(most, (one.point - there).norm());
  }
  return most;
}

constexpr double kExact = 1e-12;  // m, of metres

JointVector listed(const SimulationSpec& spec, int pose) { return spec.postures[static_cast<std::size_t>(pose)].q; }

TEST(SimulationUnloaded, isPosturesAtStepZeroAlone) {
  SimulationSpec spec = rigidDay();
  spec.nests = {{"N1", {2, -2, 0}}};
  const campaign::Campaign campaign = dayOf(spec);
  EXPECT_EQ(campaign.states->rows.size(), 4u);
  EXPECT_EQ(campaign.loading->rows.size(), 4u * 2 * 3);
  EXPECT_EQ(campaign.nests->rows.size(), 2u);
  EXPECT_FALSE(campaign.circle_sweeps || campaign.wrist_sweep || campaign.load_cell || campaign.tool);
  for (const campaign::State& state : campaign.states->rows) {
    EXPECT_EQ(state.step, 0);
    EXPECT_TRUE(state.wrench_in_cell.isZero(0.0));
    EXPECT_TRUE(std::isnan(state.extras().temperature_c));
  }
  EXPECT_LT(farthestFrom(spec, [&](int pose) { return listed(spec, pose); }), kExact);
}

TEST(SimulationUnloaded, ratioOfTheOwnAngleAndOfAnothers) {
  SimulationSpec spec = rigidDay();
  spec.machine.joints[1].ratio = JointRatio{2e-4, 1};
  spec.machine.joints[4].ratio = JointRatio{-3e-4, 3};
  EXPECT_LT(farthestFrom(spec,
                         [&](int pose) {
                           JointVector q = listed(spec, pose);
                           q[4] -= 3e-4 * q[3];
                           q[1] *= 1.0 + 2e-4;
                           return q;
                         }),
            kExact);
}

TEST(SimulationUnloaded, gearErrorOfAnOrderThatIsNotWhole) {
  SimulationSpec spec = rigidDay();
  spec.machine.joints[1].angle_wave = JointWave{5e-5, 17.25, 0.7};
  EXPECT_LT(farthestFrom(spec,
                         [&](int pose) {
                           JointVector q = listed(spec, pose);
                           q[1] += 5e-5 * std::sin(17.25 * q[1] + 0.7);
                           return q;
                         }),
            kExact);
}

// From zero to 20 deg, down, up, and down to the same 20 deg: the link lags, above where it came down.
TEST(SimulationUnloaded, playLagsOnTheSideFromWhichTheJointCame) {
  SimulationSpec spec = rigidDay();
  const double half = 4e-5;
  spec.machine.joints[0].lost_motion = LostMotion{2.0 * half, {}};
  const std::array<double, 4> sides{1.0, -1.0, 1.0, -1.0};  // 20, -30, 60, 20 deg
  EXPECT_LT(farthestFrom(spec,
                         [&](int pose) {
                           JointVector q = listed(spec, pose);
                           q[0] -= half * sides[static_cast<std::size_t>(pose)];
                           return q;
                         }),
            kExact);
  EXPECT_EQ(dayOf(spec).states->rows[0].q, spec.postures[0].q);  // as the motor's encoder says
}

TEST(SimulationUnloaded, aJointThatStandsKeepsItsSide) {
  Arrival arrival(6);
  arrival.moveTo(deg(10, 0, 0, 0, 0, 0));
  arrival.moveTo(deg(10, -5, 0, 0, 0, 0));
  EXPECT_EQ(arrival.side, (Vector6d() << 1, -1, 0, 0, 0, 0).finished());
  EXPECT_EQ(arrival.from, deg(10, 0, 0, 0, 0, 0));
}

// 50 kg stand out by 1.3 m at 2.0 m height on the forearm: about axis 2 (+y, at x 0.4 m) 50 * 9.80665 * 1.3 Nm,
// forward.
TEST(SimulationUnloaded, aTorqueAboveFrictionTakesTheLinkToItsOwnSide) {
  SimulationSpec spec = rigidDay();
  spec.nominal.bodies[3] = {50.0, Vector3d(1.7, 0.0, 2.0)};
  const double torque = 50.0 * 9.80665 * 1.3, width = 6e-5;
  // Joint 2 stays at zero, then comes up: held by friction its link would lag, by the weight it is ahead both times.
  spec.postures = {{deg(0, 0, 0, 0, 30, 0), {}}, {deg(0, 5, 0, 0, 30, 0), {}}};
  for (const bool held : {false, true}) {
    spec.machine.joints[1].lost_motion = LostMotion{width, held ? 1.1 * torque : 0.9 * torque};
    EXPECT_LT(farthestFrom(spec,
                           [&](int pose) {
                             JointVector q = listed(spec, pose);
                             // At its first posture the joint has not moved from zero; leaning 5 deg the torque is
                             // within a tenth: 1.3 cos 5 + 1.1 sin 5 = 1.39 m.
                             q[1] += held ? (pose == 0 ? 0.0 : -0.5 * width) : 0.5 * width;
                             return q;
                           }),
              kExact)
        << held;
  }
}

TEST(SimulationUnloaded, anEarlyLogLacksAShareOfTheMove) {
  SimulationSpec spec = rigidDay();
  spec.early_log = EarlyLog{0.4, JointVector::Constant(6, 0.08)};
  spec.early_log->time_constants[5] = 0.05;
  const campaign::Campaign campaign = dayOf(spec);
  JointVector before = JointVector::Zero(6);
  for (std::size_t p = 0; p < spec.postures.size(); ++p) {
    const JointVector move = spec.postures[p].q - before;
    JointVector expected = spec.postures[p].q - std::exp(-5.0) * move;
    expected[5] = spec.postures[p].q[5] - std::exp(-8.0) * move[5];
    EXPECT_LT((campaign.states->rows[p].q - expected).norm(), 1e-15);
    before = spec.postures[p].q;
  }
  EXPECT_LT(farthestFrom(spec, [&](int pose) { return listed(spec, pose); }), kExact);  // the arm itself has arrived
}

TEST(SimulationUnloaded, aBeltSlipsAtATime) {
  SimulationSpec spec = rigidDay();
  const double from_s = dayOf(spec).states->rows[2].time_s;
  spec.machine.joints[2].zero_jump = ZeroJump{1e-4, from_s};
  EXPECT_LT(farthestFrom(spec,
                         [&](int pose) {
                           JointVector q = listed(spec, pose);
                           if (pose >= 2) q[2] += 1e-4;
                           return q;
                         }),
            kExact);
}

// A ramp of v K/s from the balance: what follows with a lag T is v t - v T (1 - exp(-t / T)).
TEST(SimulationTemperature, lagsBehindARamp) {
  const TemperatureCourse course{{0.0, 1000.0, 2000.0}, {20.0, 24.0, 24.0}};
  EXPECT_DOUBLE_EQ(course.at(-5.0), 20.0);
  EXPECT_DOUBLE_EQ(course.at(250.0), 21.0);
  EXPECT_DOUBLE_EQ(course.at(9e9), 24.0);
  const double lag = 300.0, v = 0.004;
  EXPECT_NEAR(course.lagged(800.0, lag), 20.0 + v * 800.0 - v * lag * -std::expm1(-800.0 / lag), 1e-12);
  const double at_knee = course.lagged(1000.0, lag);
  EXPECT_NEAR(course.lagged(1600.0, lag), 24.0 + (at_knee - 24.0) * std::exp(-2.0), 1e-12);
  EXPECT_NEAR(course.lagged(4000.0, lag), 24.0 + (at_knee - 24.0) * std::exp(-10.0), 1e-12);
  EXPECT_EQ(course.lagged(700.0, 0.0), course.at(700.0));
}

// The upper arm is 1.1 m, from (0.4, 0, 0.9) to (0.4, 0, 2.0): everything beyond axis 3 goes up along it.
TEST(SimulationUnloaded, linksGrowAndZerosWanderWithTemperature) {
  SimulationSpec spec = rigidDay();
  spec.temperature = TemperatureCourse{{0.0, 100.0}, {20.0, 25.0}};
  spec.machine.growths = {{1, 0.0, 1.0, 1.2e-5}};
  const campaign::Campaign campaign = dayOf(spec);
  for (const campaign::State& state : campaign.states->rows) {
    const double warmer = spec.temperature->at(state.time_s) - 20.0;
    EXPECT_EQ(state.extras().temperature_c, 20.0 + warmer);
    EXPECT_GT(warmer, 0.1);
    const Eigen::Matrix3d upper =
        (Eigen::AngleAxisd(state.q[0], Vector3d::UnitZ()) * Eigen::AngleAxisd(state.q[1], Vector3d::UnitY()))
            .toRotationMatrix();
    for (const campaign::LoadingReading& one : campaign.loading->rows) {
      if (one.pose != state.pose) continue;
      const Vector3d rigid =
          shownAt(spec, state.q, spec.targets[static_cast<std::size_t>(one.target)].position_in_flange);
      // The tracker's axes are those of base_link here. The machine stands as it was when the arm arrived.
      EXPECT_LT((one.point - rigid - 1.2e-5 * warmer * upper.col(2)).norm(), kExact);
    }
  }
  spec.machine.growths.clear();
  spec.machine.joints[3].zero_warming = ZeroWarming{2e-5, 50.0};
  EXPECT_LT(farthestFrom(spec,
                         [&](int pose) {
                           const double time = campaign.states->rows[static_cast<std::size_t>(pose)].time_s;
                           JointVector q = listed(spec, pose);
                           q[3] += 2e-5 * (spec.temperature->lagged(time, 50.0) - 20.0);
                           return q;
                         }),
            kExact);
}

TEST(SimulationUnloaded, aReflectorIsReseatedAtATime) {
  SimulationSpec spec = rigidDay();
  const campaign::Campaign before = dayOf(spec);
  TargetMotion motion;
  motion.kind = TargetMotion::Kind::reseated;
  motion.shift = Vector3d(3e-5, -1e-5, 2e-5);
  motion.from_s = before.states->rows[2].time_s;
  spec.targets[1].motion = motion;
  const campaign::Campaign after = dayOf(spec);
  for (std::size_t r = 0; r < before.loading->rows.size(); ++r) {
    const campaign::LoadingReading& one = before.loading->rows[r];
    const Vector3d shift = after.loading->rows[r].point - one.point;
    const bool moved = one.target == 1 && one.pose >= 2;
    const Eigen::Matrix3d flange = nominalFlange(spec.nominal, listed(spec, one.pose)).linear();
    EXPECT_LT((shift - (moved ? Vector3d(flange * motion.shift) : Vector3d(Vector3d::Zero()))).norm(), kExact);
  }
}

TEST(SimulationUnloaded, aReflectorRattlesBetweenTwoSeats) {
  SimulationSpec spec = rigidDay();
  spec.postures.clear();
  for (int p = 0; p < 60; ++p) spec.postures.push_back({p % 2 == 0 ? posture() : JointVector(0.5 * posture()), {}});
  const campaign::Campaign before = dayOf(spec);
  TargetMotion motion;
  motion.kind = TargetMotion::Kind::rattling;
  motion.shift = Vector3d(0, 4e-5, 0);
  spec.targets[2].motion = motion;
  const auto seats = [&] {
    std::vector<int> second(60, 0);
    const campaign::Campaign after = dayOf(spec);
    for (std::size_t r = 0; r < before.loading->rows.size(); ++r) {
      const campaign::LoadingReading& one = before.loading->rows[r];
      const double shift = (after.loading->rows[r].point - one.point).norm();
      if (one.target != 2) {
        EXPECT_EQ(shift, 0.0);
        continue;
      }
      EXPECT_TRUE(shift == 0.0 || std::abs(shift - 4e-5) < kExact) << shift;
      second[static_cast<std::size_t>(one.pose)] += shift > 0.0 ? 1 : 0;
    }
    return second;
  };
  const std::vector<int> first = seats();
  int count = 0;
  for (const int readings : first) {
    EXPECT_TRUE(readings == 0 || readings == spec.unloaded_repeats);  // both repeats of a posture alike
    count += readings > 0 ? 1 : 0;
  }
  EXPECT_NEAR(count, 30, 15);  // four standard deviations of 60 throws
  spec.measurement = 2;
  EXPECT_NE(seats(), first);
}

// Flange x is up at all joints zero: gravity pulls against it, the first seat. Turned half round by axis 6, the second.
TEST(SimulationUnloaded, aLoosePlateLiesWhereItsWeightPullsIt) {
  SimulationSpec spec = rigidDay();
  spec.postures = {{deg(0, 0, 0, 0, 0, 10), {}}, {deg(0, 0, 0, 0, 0, 170), {}}};
  const campaign::Campaign before = dayOf(spec);
  spec.machine.loose_plate = LoosePlate{Vector3d::UnitX(), Vector3d(1e-5, 2e-5, 0), Vector3d(0, 0, 1e-4)};
  const campaign::Campaign after = dayOf(spec);
  for (std::size_t r = 0; r < before.loading->rows.size(); ++r) {
    const campaign::LoadingReading& one = before.loading->rows[r];
    const Vector3d place = spec.targets[static_cast<std::size_t>(one.target)].position_in_flange;
    const Vector3d moved = rotationExp(Vector3d(0, 0, 1e-4)) * place - place + Vector3d(1e-5, 2e-5, 0);
    const Eigen::Matrix3d flange = nominalFlange(spec.nominal, listed(spec, one.pose)).linear();
    const Vector3d expected = one.pose == 1 ? Vector3d(flange * moved) : Vector3d(Vector3d::Zero());
    EXPECT_LT((after.loading->rows[r].point - one.point - expected).norm(), kExact);
  }
}

// A mass of 100 kg 1.3 m in front of axis 2, whose joint gives 1/k: the reflectors turn about it by 100 g 1.3 / k.
TEST(SimulationUnloaded, theOwnWeightTwistsAJoint) {
  SimulationSpec spec = rigidDay();
  spec.postures = {{deg(0, 0, 0, 0, 0, 0), {}}};
  spec.nominal.bodies[3] = {100.0, Vector3d(1.7, 0.0, 2.0)};
  const double k = 4e7, turn = 100.0 * 9.80665 * 1.3 / k;
  spec.machine.joints[1].torsion = k;
  // The torque grows by the lean: a share of m g h / k = 100 * 9.8 * 1.1 / 4e7 of 3e-5 rad.
  EXPECT_LT(farthestFrom(spec, [&](int) { return JointVector(turn * JointVector::Unit(6, 1)); }), 3e-5 * 3e-5 * 3.0);
}

/// Station of which only this is wrong, at the origin with base_link's axes.
Station stationWith(const StationSpec& wrong) {
  SimulationSpec spec = armSpec();
  spec.tracker.base_from_tracker.setIdentity();
  spec.station = wrong;
  return Station(spec);
}

TEST(SimulationStation, wandersTowardsALimit) {
  StationSpec wrong;
  wrong.limit[1] = 2e-4;
  wrong.limit_time = 600.0;
  const Station station = stationWith(wrong);
  EXPECT_NEAR(station.wandered(600.0)[1], 2e-4 * (1.0 - std::exp(-1.0)), 1e-18);
  // The station went by +y, so that everything reads less.
  EXPECT_NEAR(station.readFloor(Vector3d(3, 1, 0), 600.0).y(), 1.0 - 2e-4 * (1.0 - std::exp(-1.0)), 1e-15);
}

// The same knots as the walk of straight lines, but no corner there: slopes before and after a knot agree.
TEST(SimulationStation, aSmoothWalkHasNoCorners) {
  StationSpec wrong;
  wrong.walk = Vector6d::Constant(1e-6);
  wrong.knot_s = 100.0;
  const Station straight = stationWith(wrong);
  wrong.smooth = true;
  const Station smooth = stationWith(wrong);
  for (int knot = 1; knot < 20; ++knot) {
    const double t = 100.0 * knot, h = 1e-3;
    EXPECT_LT((smooth.wandered(t) - straight.wandered(t)).norm(), 1e-18);
    const Vector6d before = smooth.wandered(t) - smooth.wandered(t - h);
    const Vector6d after = smooth.wandered(t + h) - smooth.wandered(t);
    // Of second order in h: curvature is at most some ten of the walk's steps (1e-5) over 100 s squared.
    EXPECT_LT((after - before).norm(), 20.0 * 1e-5 * 1e-4 * h * h + 1e-18);
  }
}

TEST(SimulationStation, isPushedAtATime) {
  StationSpec wrong;
  wrong.robot_moved = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1e-4));
  wrong.robot_moved_s = 50.0;
  wrong.tracker_moved = Eigen::Isometry3d(Eigen::Translation3d(2e-4, 0, 0));
  wrong.tracker_moved_s = 80.0;
  const Station station = stationWith(wrong);
  const Vector3d point(3, 1, 2);
  EXPECT_EQ(station.readRobot(point, 49.0), point);
  EXPECT_LT((station.readRobot(point, 51.0) - point - Vector3d(0, 0, 1e-4)).norm(), 1e-15);
  EXPECT_EQ(station.readFloor(point, 79.0), point);
  EXPECT_LT((station.readRobot(point, 81.0) - point - Vector3d(-2e-4, 0, 1e-4)).norm(), 1e-15);
}

TEST(SimulationStation, scaleStepsAndAirBends) {
  StationSpec wrong;
  wrong.scale_step = 2e-5;
  wrong.scale_step_s = 10.0;
  const Vector3d point(3, 4, 2);
  EXPECT_EQ(stationWith(wrong).readFloor(point, 9.0), point);
  EXPECT_LT((stationWith(wrong).readFloor(point, 10.0) - (1.0 + 2e-5) * point).norm(), 1e-15);
  // 5 m away and 2 m up: 25 / 2 (1e-6 + 2 * 3e-6) m higher.
  StationSpec air;
  air.bending = 1e-6;
  air.bending_per_m = 3e-6;
  EXPECT_LT((stationWith(air).readFloor(point, 0.0) - point - Vector3d(0, 0, 12.5 * 7e-6)).norm(), 1e-15);
}

}  // namespace unloaded_day_test

}  // namespace stiffscope
