#include <cmath>
#include "core/numerics/random.h"
#include "core/simulation/instruments.h"
#include "tests/fixtures/simulation_fixture.h"

namespace stiffscope {

using namespace simulation;
using namespace simulation_test;
using Eigen::Vector3d;

namespace day_test {

/// Three weights and back to zero at two postures, a short sweep, nests.
simulation::SimulationSpec day() {
  simulation::SimulationSpec spec = armSpec();
  spec.load_cell.emplace();
  spec.load_cell->declared.parent = "tool0";
  spec.load_cell->declared.parent_from_cell.translation() = Vector3d(0, 0, 0.11);
  spec.loading.emplace();
  spec.loading->load = simulation::HangingWeights{{50.0, 100.0, 150.0}};
  spec.loading->hook_in_flange = Vector3d(0.1, 0.06, 0.2);
  spec.postures = {{posture(), {}}, {0.5 * posture(), {}}};
  spec.circle_sweeps = {{1, -0.5, 0.5, 5, JointVector::Zero(6)}};
  spec.nests = {{"N1", {2, -2, 0}}, {"N2", {1, 2, 0}}, {"N3", {3, 1, 0.5}}};
  spec.nests_after_sweeps = true;
  return spec;
}

campaign::Campaign perfect(const simulation::SimulationSpec& spec) {
  return simulation::measureWithoutNoise(simulation::buildMachine(spec), spec);
}

/// Largest difference of two tables' points, rows where `counts`.
template <class Rows, class Counts>
double farthest(const Rows& a, const Rows& b, const Counts& counts) {
  double most = 0.0;
  for (std::size_t r = 0; r < a.rows.size(); ++r) {
    if (counts(a.rows[r])) most = std::max(most, (a.rows[r].point - b.rows[r].point).norm());
  }
  return most;
}
constexpr auto kEvery = [](const auto&) { return true; };

TEST(SimulationDay, aPushedTrackerMovesNestsAndLoadingButNoSweep) {
  simulation::SimulationSpec spec = day();
  const campaign::Campaign before = perfect(spec);
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.translation() = Vector3d(3e-4, -1e-4, 2e-4);
  spec.station.tracker_moved = moved;
  const campaign::Campaign after = perfect(spec);
  EXPECT_EQ(farthest(*before.circle_sweeps, *after.circle_sweeps, kEvery), 0.0);
  for (std::size_t r = 0; r < before.loading->rows.size(); ++r) {
    // The station went by +d, so everything reads less by d.
    const Vector3d shift = after.loading->rows[r].point - before.loading->rows[r].point;
    EXPECT_LT((shift + moved.translation()).norm(), 1e-14);
  }
  EXPECT_EQ(farthest(*before.nests, *after.nests, [&](const campaign::NestReading& one) { return one.time_s < 100.0; }),
            0.0);
  EXPECT_NEAR(farthest(*before.nests, *after.nests, kEvery), moved.translation().norm(), 1e-14);
}

TEST(SimulationDay, aPushedRobotLeavesTheNests) {
  simulation::SimulationSpec spec = day();
  const campaign::Campaign before = perfect(spec);
  spec.station.robot_moved = Eigen::Isometry3d(Eigen::AngleAxisd(2e-4, Vector3d::UnitZ()));
  const campaign::Campaign after = perfect(spec);
  EXPECT_EQ(farthest(*before.nests, *after.nests, kEvery), 0.0);
  EXPECT_EQ(farthest(*before.circle_sweeps, *after.circle_sweeps, kEvery), 0.0);
  const double moved = farthest(*before.loading, *after.loading, kEvery);
  EXPECT_GT(moved, 2e-4 * 1.5);  // the tool is some 2 m from axis 1
  EXPECT_LT(moved, 2e-4 * 2.5);
}

// 36 mm/h for an hour along x and a turn of 0.1 rad/h about z; and the walk's sigma after four knots.
TEST(SimulationDay, stationWandersByHand) {
  simulation::SimulationSpec spec = day();
  spec.tracker.base_from_tracker.setIdentity();
  spec.station.ramp << 1e-5, 0, 0, 0, 0, 0.1 / 3600;
  const simulation::Station ramp(spec);
  const Vector3d point(3, 1, 0.5), seen = ramp.readFloor(point, 3600.0);
  const Vector3d expected = Eigen::AngleAxisd(-0.1, Vector3d::UnitZ()) * (point - Vector3d(0.036, 0, 0));
  EXPECT_LT((seen - expected).norm(), 1e-14);
  EXPECT_EQ(ramp.readFloor(point, 0.0), point);

  spec.station = {};
  spec.station.walk << 1e-6, 0, 0, 0, 0, 2e-7;
  double square = 0.0;
  const int days = 2000;
  for (int d = 0; d < days; ++d) {
    spec.measurement = static_cast<std::uint64_t>(d + 1);
    square += std::pow(simulation::Station(spec).wandered(2400.0)[0], 2);
  }
  // Variance 2400 s x (1 um)^2; its estimate from 2000 days has a relative sigma of sqrt(2 / 2000) = 3 %.
  EXPECT_NEAR(square / days / (2400.0 * 1e-12), 1.0, 0.13);
}

TEST(SimulationDay, refractionScalesDistancesFromTheStation) {
  simulation::SimulationSpec spec = day();
  spec.station.scale = 1e-5;
  spec.station.scale_per_second = 1e-9;
  const simulation::Station station(spec);
  const Vector3d point = spec.tracker.base_from_tracker * Vector3d(2, -1, 2);
  EXPECT_LT((station.readRobot(point, 1000.0) - (1 + 1.1e-5) * Vector3d(2, -1, 2)).norm(), 1e-14);
}

TEST(SimulationDay, reflectorsLeaveTheirNestsUnderLoad) {
  simulation::SimulationSpec spec = day();
  const campaign::Campaign before = perfect(spec);
  simulation::TargetMotion motion{simulation::TargetMotion::Kind::proportional, Vector3d(3e-5, 0, 4e-5), 1000.0, 0.0};
  const auto moves = [&](int step, int target) {
    spec.targets[2].motion = motion;
    return farthest(*before.loading, *perfect(spec).loading,
                    [&](const campaign::LoadingReading& one) { return one.step == step && one.target == target; });
  };
  const double g = 9.80665;
  EXPECT_NEAR(moves(3, 2), 5e-5 * 150 * g / 1000, 1e-15);
  EXPECT_EQ(moves(3, 1), 0.0);
  EXPECT_EQ(moves(4, 2), 0.0);
  motion.kind = simulation::TargetMotion::Kind::slip;  // between the first and the second weight, and stays
  motion.at_force = 75 * g;
  EXPECT_EQ(moves(1, 2), 0.0);
  EXPECT_NEAR(moves(2, 2), 5e-5, 1e-15);
  EXPECT_NEAR(moves(4, 2), 5e-5, 1e-15);
  EXPECT_EQ(moves(0, 2), 0.0);  // the second posture starts seated
  motion = {simulation::TargetMotion::Kind::compliant, Vector3d::Zero(), 1.0, 2e-8};
  EXPECT_NEAR(moves(2, 2), 2e-8 * 100 * g, 1e-15);
}

// The cell 10 mm off its declared place reads the moment short by 10 mm x F; the machine does not change.
TEST(SimulationDay, aMisplacedCellReadsOtherMoments) {
  simulation::SimulationSpec spec = day();
  const campaign::Campaign before = perfect(spec);
  spec.load_cell->place_error = Vector3d(0.01, -0.02, 0.005);
  const campaign::Campaign after = perfect(spec);
  EXPECT_EQ(farthest(*before.loading, *after.loading, kEvery), 0.0);
  for (std::size_t r = 0; r < before.states->rows.size(); ++r) {
    const Vector6d& a = before.states->rows[r].wrench_in_cell;
    const Vector6d& b = after.states->rows[r].wrench_in_cell;
    const Vector3d force = a.head<3>();
    EXPECT_LT((b.tail<3>() - a.tail<3>() + spec.load_cell->place_error.cross(force)).norm(), 1e-10);
    EXPECT_EQ(a.head<3>(), b.head<3>());
  }
}

// A shackle of 5 kg that was tared away: the machine gives as under 55, 105, 155 kg, the cell reads 50, 100,
// 150.
TEST(SimulationDay, unreadForceLoadsTheMachineOnly) {
  simulation::SimulationSpec spec = day(), heavier = day();
  spec.load_cell->unread_force = 5.0 * Vector3d(0, 0, -9.80665);
  heavier.loading->load = simulation::HangingWeights{{55.0, 105.0, 155.0}};
  const campaign::Campaign read = perfect(spec), all = perfect(heavier), light = perfect(day());
  EXPECT_LT(farthest(*read.loading, *all.loading, kEvery), 1e-11);  // the solver's promise, 2 m out
  for (std::size_t r = 0; r < read.states->rows.size(); ++r) {
    EXPECT_NEAR(read.states->rows[r].wrench_in_cell.head<3>().norm(),
                light.states->rows[r].wrench_in_cell.head<3>().norm(), 1e-9);
  }
}

// 30 % comes late with 100 s: a reading t after the load has 0.3 exp(-t / 100) of the way still to go.
TEST(SimulationDay, creepByHand) {
  simulation::SimulationSpec spec = day();
  const campaign::Campaign at_once = perfect(spec);
  spec.machine.creep = simulation::Creep{0.3, 100.0};
  const campaign::Campaign late = perfect(spec);
  const auto& rows = at_once.loading->rows;
  for (std::size_t r = 0; r < 18; ++r) {  // the first posture, unloaded and first weight
    const double since = rows[r].time_s - (rows[r < 9 ? 0 : 9].time_s - spec.timing.reading_s);
    const Vector3d way = rows[r].point - rows[r % 9].point;
    const Vector3d missing = rows[r].point - late.loading->rows[r].point;
    EXPECT_LT((missing - 0.3 * std::exp(-since / 100.0) * way).norm(),
              1e-3 * way.norm() + 1e-15);  // finite turns
  }
  spec.machine.creep = simulation::Creep{0.3, 0.05};  // over before the first reading, two seconds after the load
  EXPECT_LT(farthest(*at_once.loading, *perfect(spec).loading, kEvery), 1e-15);
}

TEST(SimulationDay, machineAtAPostureAndATime) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.joints[1].rate_wave = simulation::JointWave{0.1, 2.0, 0.3};
  spec.machine.joints[2].softening = simulation::JointSoftening{0.2, 3600.0};
  spec.machine.joints[4].angle_wave = simulation::JointWave{1e-4, 1.0, 0.0};
  spec.machine.growths = {{3, 1e-3, 3600.0}};
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  ASSERT_TRUE(machine.changes());
  const JointVector q = posture();
  const simulation::ElasticMachine now = simulation::machineAt(machine, q, 3600.0);
  const double come = 1.0 - std::exp(-1.0);
  EXPECT_NEAR(now.elements[1].stiffness(5, 5), 3e6 * (1 + 0.1 * std::sin(2 * q[1] + 0.3)), 1e-6);
  EXPECT_NEAR(now.elements[2].stiffness(5, 5), 2.5e6 * (1 - 0.2 * come), 1e-6);
  EXPECT_NEAR(now.zeros[4], 1e-4 * std::sin(q[4]), 1e-18);
  // The forearm points along +x at zero: axis 5 and all beyond it have gone 0.63 mm that way.
  EXPECT_LT((now.axis_errors[4].translation() - Vector3d(1e-3 * come, 0, 0)).norm(), 1e-16);
  EXPECT_TRUE(simulation::machineAt(machine, q, 0.0).axis_errors[4].isApprox(machine.axis_errors[4], 0.0));
}

// Swinging by 2 deg at 1.3 s while targets are read every 2 s: readings scatter about the still ones by the
// arm's give under the sideways 3.5 % of the weight.
TEST(SimulationDay, aSwingingWeightScattersLoadedReadingsOnly) {
  simulation::SimulationSpec spec = day();
  const campaign::Campaign still = perfect(spec);
  spec.loading->swing = 2 * kDeg;
  spec.loading->swing_period = 1.3;
  const campaign::Campaign swinging = perfect(spec);
  const auto loaded = [](const campaign::LoadingReading& one) { return one.step == 3; };
  const auto unloaded = [](const campaign::LoadingReading& one) { return one.step == 0 || one.step == 4; };
  EXPECT_EQ(farthest(*still.loading, *swinging.loading, unloaded), 0.0);
  const double moved = farthest(*still.loading, *swinging.loading, loaded);
  EXPECT_GT(moved, 1e-6);
  EXPECT_LT(moved, 5e-4);
  for (std::size_t r = 0; r < still.states->rows.size(); ++r) {
    EXPECT_EQ(still.states->rows[r].wrench_in_cell, swinging.states->rows[r].wrench_in_cell);
  }
}

}  // namespace day_test

}  // namespace stiffscope
