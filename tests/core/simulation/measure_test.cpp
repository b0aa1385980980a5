#include <algorithm>
#include <map>
#include "core/simulation/equilibrium.h"
#include "core/simulation/postures.h"
#include "tests/fixtures/simulation_fixture.h"

namespace stiffscope {

using namespace simulation_test;
using Eigen::Vector3d;

namespace measure_test {

/// A short day: two weights and back to zero at four postures, sweeps of two axes and of the wrist, two
/// nests.
simulation::SimulationSpec day() {
  simulation::SimulationSpec spec = fullSpec();
  spec.read_back_resolution = 1e-5 * kDeg;
  spec.load_cell.emplace();
  spec.load_cell->declared.parent = "tool0";
  spec.load_cell->declared.parent_from_cell.translation() = Vector3d(0, 0, 0.11);
  spec.load_cell->declared.force_sigma = 1.0;
  spec.load_cell->declared.moment_sigma = 0.3;
  spec.loading.emplace();
  spec.loading->load = simulation::HangingWeights{{50.0, 150.0}};
  spec.loading->hook_in_flange = Vector3d(0.1, 0.06, 0.2);
  spec.posture_draw.emplace(6);
  spec.posture_draw->count = 4;
  spec.posture_draw->low = kDeg * (Vector6d() << -40, -30, -50, -90, -90, -120).finished();
  spec.posture_draw->high = kDeg * (Vector6d() << 40, 40, 20, 90, 90, 120).finished();
  spec.posture_draw->min_abs_sin_bend = 0.5;
  spec.posture_draw->min_height = 0.9;
  spec.posture_draw->max_flange_up = 20 * kDeg;
  spec.posture_draw->min_hang_clearance = 0.15;
  spec.circle_sweeps = {{1, -0.5, 0.5, 5, JointVector::Zero(6)}, {4, -1.0, 1.0, 6, posture()}};
  spec.wrist_sweep.emplace();
  spec.wrist_sweep->readings = 10;
  spec.wrist_sweep->low = Vector3d(-2, -1, -2);
  spec.wrist_sweep->high = Vector3d(2, 1, 2);
  spec.nests = {{"N1", {2, -2, 0}}, {"N2", {1, 2, 0}}};
  return spec;
}

bool samePoints(const campaign::Campaign& a, const campaign::Campaign& b) {
  const auto same = [](const auto& left, const auto& right) {
    return std::equal(left.rows.begin(), left.rows.end(), right.rows.begin(), right.rows.end(),
                      [](const auto& l, const auto& r) { return l.point == r.point; });
  };
  return same(*a.loading, *b.loading) && same(*a.circle_sweeps, *b.circle_sweeps) &&
         same(*a.wrist_sweep, *b.wrist_sweep) && same(*a.nests, *b.nests);
}

TEST(SimulationMeasure, everyTableHasTheRowsAskedFor) {
  const campaign::Campaign campaign = simulation::simulate(day());
  EXPECT_EQ(campaign.circle_sweeps->rows.size(), 3u * (5 + 6));
  EXPECT_EQ(campaign.wrist_sweep->rows.size(), 10u);
  EXPECT_EQ(campaign.loading->rows.size(), 4u * 4 * 3 * 3);  // poses, steps, repeats, targets
  EXPECT_EQ(campaign.states->rows.size(), 4u * 4);
  EXPECT_EQ(campaign.nests->rows.size(), 2u * 2);
  std::map<int, int> of_target;
  for (const campaign::WristReading& reading : campaign.wrist_sweep->rows) ++of_target[reading.target];
  EXPECT_EQ(of_target, (std::map<int, int>{{0, 4}, {1, 3}, {2, 3}}));
  double before = -1.0;
  for (const campaign::LoadingReading& reading : campaign.loading->rows) {
    EXPECT_GT(reading.time_s, before);
    before = reading.time_s;
  }
  EXPECT_FALSE(campaign.targets[0].position_in_flange);           // the truth stays with the simulator
  EXPECT_EQ(campaign.gravity_in_base, Vector3d(0, 0, -9.80665));  // the tilt was not declared
}

TEST(SimulationMeasure, withoutNoiseItIsTheEquilibrium) {
  const simulation::SimulationSpec spec = day();
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const campaign::Campaign campaign = simulation::measureWithoutNoise(machine, spec);
  const auto postures = simulation::loadingPostures(spec);
  const Eigen::Isometry3d tracker_from_base = spec.tracker.base_from_tracker.inverse();
  for (const campaign::LoadingReading& reading : campaign.loading->rows) {
    const simulation::DeadForce weight{spec.loading->hook_in_flange,
                                       (reading.step == 1 ? 50.0 : 150.0) * machine.gravity_in_base};
    const bool loaded = reading.step == 1 || reading.step == 2;
    const simulation::MachineState state = simulation::equilibrium(
        machine, postures[reading.pose].q, loaded ? simulation::AppliedLoad(weight) : simulation::AppliedLoad());
    EXPECT_EQ(reading.point, tracker_from_base * state.targets_in_base[reading.target]);
  }
  for (const campaign::State& row : campaign.states->rows) {
    EXPECT_LT((row.q - postures[row.pose].q).cwiseAbs().maxCoeff(), 0.5000001 * spec.read_back_resolution);
    const double mass = row.step == 1 ? 50.0 : row.step == 2 ? 150.0 : 0.0;
    EXPECT_NEAR(row.wrench_in_cell.head<3>().norm(), mass * 9.80665,
                1e-9);  // a force has no size but its own
    if (mass == 0.0) continue;
    // The moment about the cell is that of the force in the hook, (0.1, 0.06, 0.09) m from it in its own
    // axes.
    const Vector3d moment = Vector3d(0.1, 0.06, 0.09).cross(Vector3d(row.wrench_in_cell.head<3>()));
    EXPECT_LT((row.wrench_in_cell.tail<3>() - moment).norm(), 1e-9);
  }
}

TEST(SimulationMeasure, sameSeedSameNumbers) {
  simulation::SimulationSpec spec = day();
  const campaign::Campaign first = simulation::simulate(spec);
  EXPECT_TRUE(samePoints(first, simulation::simulate(spec)));
  spec.seed = 8;
  EXPECT_FALSE(samePoints(first, simulation::simulate(spec)));
}

// Another measurement of the machine is the same truth with other noise.
TEST(SimulationMeasure, measurementsShareTheMachineNotTheNoise) {
  simulation::SimulationSpec spec = day();
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const campaign::Campaign truth = simulation::measureWithoutNoise(machine, spec), first = simulation::simulate(spec);
  spec.measurement = 2;
  EXPECT_TRUE(samePoints(truth, simulation::measureWithoutNoise(simulation::buildMachine(spec), spec)));
  const campaign::Campaign second = simulation::simulate(spec);
  double product = 0.0, square = 0.0;
  for (std::size_t r = 0; r < first.loading->rows.size(); ++r) {
    const Vector3d a = first.loading->rows[r].point - truth.loading->rows[r].point;
    const Vector3d b = second.loading->rows[r].point - truth.loading->rows[r].point;
    product += a.dot(b);
    square += a.squaredNorm();
  }
  EXPECT_LT(std::abs(product / square), 0.25);  // 432 numbers: a correlation of 0 +- 0.05
}

TEST(SimulationMeasure, drawnPosturesKeepTheirRulesAndAreNested) {
  simulation::SimulationSpec spec = day();
  spec.posture_draw->candidates = 5;
  spec.posture_draw->count = 12;
  const auto many = simulation::loadingPostures(spec);
  spec.posture_draw->count = 5;
  const auto few = simulation::loadingPostures(spec);
  ASSERT_EQ(many.size(), 12u);
  for (std::size_t p = 0; p < few.size(); ++p) EXPECT_EQ(few[p].q, many[p].q);
  for (const auto& posture : many) {
    EXPECT_GE(std::abs(std::sin(posture.q[4])), 0.5);
    const Eigen::Isometry3d flange = simulation::nominalFlange(spec.nominal, posture.q);
    EXPECT_GE(flange.translation().z(), 0.9);
    EXPECT_LE(flange.linear()(2, 2), std::sin(20 * kDeg) + 1e-12);
    EXPECT_GE(simulation::hangClearance(spec.nominal, posture.q, spec.loading->hook_in_flange), 0.15);
  }
  spec.posture_draw->min_height = 5.0;
  try {
    simulation::loadingPostures(spec);
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("expected rules that some posture of the box keeps"), std::string::npos)
        << error.what();
  }
}

// At zero the flange is level, 2 m out and 2.2 m high. 0.2 m ahead of it and 0.1 m above, the nearest lower
// part of the arm is the flange itself, 0.2 m back.
TEST(SimulationMeasure, hangClearanceByHand) {
  EXPECT_NEAR(simulation::hangClearance(arm(), JointVector::Zero(6), Vector3d(0.1, 0, 0.2)), 0.2, 1e-12);
  // 0.1 m below the flange's level only shoulder and upper arm are lower, at x = 0.4 m.
  EXPECT_NEAR(simulation::hangClearance(arm(), JointVector::Zero(6), Vector3d(-0.1, 0, 0.2)), 1.8, 1e-12);
}

TEST(SimulationMeasure, cablesPullTowardsTheirAnchorOrTheirDirection) {
  simulation::LoadingSpec loading;
  loading.load = simulation::CablePull{{100.0, 200.0}, Vector3d(1, 0, 0), std::nullopt};
  const Vector3d gravity(0, 0, -9.8), point(1, 2, 0);
  EXPECT_EQ(simulation::loadSteps(loading), 3);
  const simulation::AppliedLoad anchored = simulation::loadAtStep(loading, 2, gravity, std::nullopt);
  EXPECT_LT((simulation::loadForce(anchored, point) - Vector3d(0, -200, 0)).norm(), 1e-12);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(simulation::loadAtStep(loading, 3, gravity, {})));
  loading.load = simulation::CablePull{{100.0}, std::nullopt, Vector3d(1, 0, 0)};
  const simulation::AppliedLoad own = simulation::loadAtStep(loading, 1, gravity, Vector3d(0, 0, 1));
  EXPECT_EQ(simulation::loadForce(own, point), Vector3d(0, 0, 100));
  const simulation::AppliedLoad common = simulation::loadAtStep(loading, 1, gravity, std::nullopt);
  EXPECT_EQ(simulation::loadForce(common, point), Vector3d(100, 0, 0));
}

TEST(SimulationMeasure, namesThePostureThatCannotCarryItsLoad) {
  simulation::SimulationSpec spec = day();
  spec.machine.joints[1].torsion = 5e4;
  spec.postures.push_back({JointVector::Zero(6), std::nullopt});
  spec.circle_sweeps.clear();
  spec.wrist_sweep.reset();
  try {
    simulation::simulate(spec);
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("q_deg: '0.000 0.000"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("rests stably"), std::string::npos) << error.what();
  }
}

}  // namespace measure_test

}  // namespace stiffscope
