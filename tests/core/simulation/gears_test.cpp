#include "core/simulation/gears.h"

#include <cmath>
#include "core/simulation/measure.h"
#include "tests/fixtures/simulation_fixture.h"

namespace stiffscope {

using namespace simulation_test;
using Eigen::Vector3d;

namespace gears_test {

TEST(SimulationGears, DriveTorqueOfAHangingLoadByHand) {
  // The fixture's arm, rigid and weightless, at zero: the flange at (2, 0, 2.2), axis 2 along y through (0.4, 0, 0.9),
  // axis 3 along -y through (0.4, 0, 2.0). 1000 N down turn axis 2 by 1600 Nm and axis 3 by -1600 Nm.
  simulation::SimulationSpec spec = armSpec();
  for (simulation::JointStiffness& joint : spec.machine.joints) joint = {};
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const simulation::AppliedLoad load = simulation::DeadForce{Vector3d::Zero(), {0, 0, -1000}, Vector3d::Zero()};
  const simulation::MachineState state = simulation::equilibrium(machine, JointVector::Zero(6), load);
  const JointVector torque = simulation::driveTorques(machine, state, load, nullptr);
  EXPECT_NEAR(torque[1], 1600.0, 1e-3);
  EXPECT_NEAR(torque[2], -1600.0, 1e-3);
  EXPECT_NEAR(torque[0], 0.0, 1e-3);
}

TEST(SimulationGears, WindUpIsOddAndCrossesTheLostMotion) {
  const simulation::JointGear gear{2e6, 4e-4};
  EXPECT_DOUBLE_EQ(simulation::windUp(gear, 1000.0), 5e-4 + 2e-4);
  EXPECT_DOUBLE_EQ(simulation::windUp(gear, -1000.0), -7e-4);
  EXPECT_DOUBLE_EQ(simulation::windUp(gear, 0.0), 0.0);
  EXPECT_NEAR(simulation::windUp(gear, 5.0), 1e-4 + 2.5e-6, 1e-18);
}

const simulation::AppliedLoad kLoad = simulation::DeadForce{{0.1, 0.06, 0.2}, {300, -200, -1500}, Vector3d::Zero()};

simulation::SimulationSpec geared() {
  simulation::SimulationSpec spec = fullSpec();
  for (auto& joint : spec.machine.joints) joint.gear = simulation::JointGear{2.0 * *joint.torsion};
  return spec;
}

TEST(SimulationGears, HeldOnTheLinkSideTheMachineStandsAsWithoutGears) {
  const simulation::ElasticMachine machine = simulation::buildMachine(geared());
  const simulation::MachineState with = simulation::equilibriumOnGears(machine, posture(), true, kLoad, nullptr);
  const simulation::MachineState without = simulation::equilibrium(machine, posture(), kLoad);
  EXPECT_EQ(with.q, posture());
  EXPECT_EQ(with.targets_in_base[0], without.targets_in_base[0]);
  for (int i = 0; i < 6; ++i) {
    // The joint's own spring carries the same torque, but for bearings that tilt its axis: 1e-3 of it.
    const double spring = without.deformation[machine.torsion_coordinates[static_cast<std::size_t>(i)]];
    EXPECT_NEAR(with.q[i] - with.motor_side[i], 0.5 * spring, 5e-3 * std::abs(0.5 * spring) + 1e-7) << i;
  }
}

TEST(SimulationGears, HeldOnTheMotorGearAndJointAreInSeries) {
  simulation::SimulationSpec spec = geared();
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const simulation::MachineState gears = simulation::equilibriumOnGears(machine, posture(), false, kLoad, nullptr);
  ASSERT_TRUE(gears.converged);
  EXPECT_EQ(gears.motor_side, posture());
  // One spring of both compliances instead: rotations of a milliradian do not commute, to some micrometres.
  for (auto& joint : spec.machine.joints) {
    joint.torsion = 1.0 / (1.0 / *joint.torsion + 1.0 / joint.gear->stiffness);
    joint.gear.reset();
  }
  const simulation::ElasticMachine soft = simulation::buildMachine(spec);
  const simulation::MachineState series = simulation::equilibrium(soft, posture(), kLoad);
  const simulation::MachineState stiff = simulation::equilibrium(machine, posture(), kLoad);
  const double moved = (series.targets_in_base[0] - stiff.targets_in_base[0]).norm();
  EXPECT_GT(moved, 1e-4);
  EXPECT_LT((gears.targets_in_base[0] - series.targets_in_base[0]).norm(), 5e-3 * moved);
}

TEST(SimulationGears, StatesHaveTheMotorsSideOfGearedJointsAlone) {
  simulation::SimulationSpec spec = fullSpec();
  spec.double_encoder = campaign::DoubleEncoder::inactive;
  spec.machine.joints[1].gear = simulation::JointGear{4e6, 0.0, 0.0, 3e-3};
  spec.load_cell.emplace();
  spec.load_cell->declared.parent = "tool0";
  spec.loading.emplace();
  spec.loading->load = simulation::HangingWeights{{150.0}};
  spec.loading->repeats = 1;
  spec.postures = {{posture(), std::nullopt}};
  const campaign::Campaign campaign = simulation::simulate(spec);
  for (const campaign::State& state : campaign.states->rows) {
    EXPECT_NEAR(state.extras().motor_side[1], posture()[1] + 3e-3, 1e-15);
    EXPECT_NE(state.q[1], posture()[1]);
    EXPECT_EQ(state.q[2], posture()[2]);
    EXPECT_TRUE(std::isnan(state.extras().motor_side[0]) && std::isnan(state.extras().motor_side[2]));
  }
}

}  // namespace gears_test
}  // namespace stiffscope
