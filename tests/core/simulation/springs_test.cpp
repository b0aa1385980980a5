#include <Eigen/LU>
#include <cmath>
#include "core/numerics/random.h"
#include "tests/fixtures/simulation_fixture.h"

namespace stiffscope {

using namespace simulation;
using namespace simulation_test;
using Eigen::Vector3d;

namespace springs_test {

/// Everything that has an energy at once: gap, friction, cubic, shared and link springs, plate, contact.
simulation::SimulationSpec everySpring() {
  simulation::SimulationSpec spec = fullSpec();
  simulation::MachineSpec& machine = spec.machine;
  machine.joints[0].backlash = simulation::JointBacklash{2e-4, 0.01};
  machine.joints[1].cubic = 1e11;
  machine.joints[2].friction = simulation::JointFriction{200.0, 4e5, 3};
  machine.joints[3].stages = simulation::JointStages{{50.0, 200.0}, {2e5, 3e5, 5e5}};
  machine.shared_springs = {{{1, 2}, {0.3, -0.25}, 8e6}, {{4, 5}, {1.0, 0.4}, 1e5}};
  machine.link_springs = {{1, 2, {-0.2, 0.3, 0.7}, {0.3, 0.3, 1.6}, 3e4, 1.2e4},
                          {0, 5, {0.1, -0.4, 0.5}, {1.6, -0.1, 2.4}, 2e3, 300.0},
                          {1, 2, {-0.4, 0.1, 0.9}, {0.3, 0.2, 1.1}, 0, 0, CylinderGas{40e5, 1e-3, 2e-3, 1.3, false}},
                          {0, 3, {-0.3, 0, 0.4}, {0.5, 0.1, 1.9}, 0, 0, CylinderGas{30e5, 5e-4, 3e-3, 1.0, true}}};
  machine.tool_plate = simulation::ToolPlate{{3e8, 4e8, 9e8}, {4e6, 5e6, 6e6}};
  machine.base_translation = Vector3d(1e9, 1e9, 3e9);
  machine.base_contacts = {{0, true, 4e7, 1e-5}};
  return spec;
}

TEST(SimulationSprings, gradientAndHessianAreThoseOfTheEnergy) {
  const simulation::ElasticMachine machine = simulation::buildMachine(everySpring());
  const simulation::DeadForce load{{0.1, 0.05, 0.2}, {300, -200, -1400}, {5, 10, -40}};
  numerics::RandomStream random(3, "test");
  Eigen::VectorXd x(machine.coordinateCount()), anchors(machine.sliderCount());
  for (double& value : x) value = 3e-4 * random.normal();
  for (double& value : anchors) value = 3e-4 * random.normal();
  const simulation::EnergySlopes slopes = simulation::energySlopes(machine, posture(), load, x, &anchors);
  const auto energy = [&](Eigen::VectorXd at, Eigen::Index k, double step) {
    at[k] += step;
    return simulation::potentialEnergy(machine, posture(), load, at, &anchors);
  };
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const double h = 1e-7;
    // The energy, some 1e4 J, is rounded to 1e-12 J, over 2e-7.
    EXPECT_NEAR(slopes.gradient[k], (energy(x, k, h) - energy(x, k, -h)) / (2 * h), 1e-3) << k;
    Eigen::VectorXd above = x, below = x;
    above[k] += h, below[k] -= h;
    const Eigen::VectorXd column = (simulation::energyGradient(machine, posture(), load, above, &anchors) -
                                    simulation::energyGradient(machine, posture(), load, below, &anchors)) /
                                   (2 * h);
    // Left out on purpose: the turning of springs (12 kN over 1 m) and terms of the element's own turn,
    // thousands of Nm/rad times 1e-3; the stiffness itself is 1e5 to 1e9.
    EXPECT_LT((column - slopes.hessian.col(k)).cwiseAbs().maxCoeff(), 2e4) << k;
  }
}

TEST(SimulationSprings, theyComeToRest) {
  const simulation::ElasticMachine machine = simulation::buildMachine(everySpring());
  const simulation::MachineState unloaded = simulation::equilibrium(machine, posture());
  ASSERT_TRUE(unloaded.converged);
  const Eigen::VectorXd anchors = simulation::arrivedAnchors(machine, unloaded);
  for (const double force : {0.0, 300.0, 1500.0, 4000.0}) {
    const simulation::AppliedLoad load = simulation::DeadForce{{0.1, 0.05, 0.2}, {0, 0.3 * force, -force}};
    const simulation::MachineState state = simulation::equilibrium(machine, posture(), load, &anchors);
    ASSERT_TRUE(state.converged) << force;
    const Eigen::VectorXd gradient = simulation::energyGradient(machine, posture(), load, state.deformation, &anchors);
    // A last step below 1e-12 rad at up to 3e9 N/m.
    EXPECT_LT(gradient.cwiseAbs().maxCoeff(), 3e-3) << force;
    if (force == 0.0) {
      EXPECT_LT((state.deformation - unloaded.deformation).norm(), 1e-11);  // sliders carry nothing there
    }
  }
}

// Maxwell and Betti: the way of point 1 along d1 under a force at 2 along d2 is that of 2 along d2 under the
// same force at 1 along d1.
TEST(SimulationSprings, reciprocity) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.shared_springs = {{{1, 2}, {0.3, -0.25}, 2e7}, {{4, 5}, {1.0, 0.7}, 2e5}};
  spec.machine.tool_plate = simulation::ToolPlate{{3e7, 4e7, 9e7}, {4e5, 5e5, 6e5}};
  spec.machine.base_translation = Vector3d(1e8, 2e8, 3e8);
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const simulation::MachineState unloaded = simulation::equilibrium(machine, posture());
  const Vector3d d1 = Vector3d(1, 2, -2) / 3, d2 = Vector3d(2, -1, 2) / 3;
  const auto way = [&](int seen, const Vector3d& along, int pulled, const Vector3d& pull) {
    const simulation::DeadForce load{spec.targets[static_cast<std::size_t>(pulled)].position_in_flange, 10.0 * pull};
    const simulation::MachineState state = simulation::equilibrium(machine, posture(), load);
    const std::size_t s = static_cast<std::size_t>(seen);
    return along.dot(state.targets_in_base[s] - unloaded.targets_in_base[s]);
  };
  const double forth = way(1, d1, 2, d2), back = way(2, d2, 1, d1);
  EXPECT_GT(std::abs(forth), 1e-6);
  EXPECT_NEAR(forth, back, 1e-4 * std::abs(forth));  // finite turns, 1e-5 rad at 10 N
}

// A rod from the crank of joint 2 (0.3 m) to that of joint 3 (0.2 m), e = 0.3 t2 + 0.2 t3: a 2x2 stiffness.
TEST(SimulationSprings, parallelogramRodByHand) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.joints.assign(6, {});
  spec.machine.joints[1].torsion = 3e6;
  spec.machine.joints[2].torsion = 2e6;
  spec.machine.shared_springs = {{{1, 2}, {0.3, 0.2}, 2e7}};
  const simulation::MachineState state =
      simulation::equilibrium(simulation::buildMachine(spec), JointVector::Zero(6),
                              simulation::DeadForce{Vector3d::Zero(), Vector3d(0, 0, -1)});
  // Both axes stand 1.6 m behind the flange; joint 3's points the other way.
  Eigen::Matrix2d stiffness;
  stiffness << 3e6 + 2e7 * 0.09, 2e7 * 0.06, 2e7 * 0.06, 2e6 + 2e7 * 0.04;
  const Eigen::Vector2d twists = stiffness.inverse() * Eigen::Vector2d(1.6, -1.6);
  EXPECT_LT((state.deformation - twists).norm(), 1e-6 * twists.norm());  // finite turns, 1e-6 rad
}

// From (-0.1, 0, 0.9) on the carousel to (0.4, 0, 1.4) on the upper arm: 45 deg, 0.5 m above axis 2, so 1 kN
// turns joint 2 by -0.5 / sqrt(2) kNm about +y (it pulls the arm back).
TEST(SimulationSprings, gravityCompensatorByHand) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.joints.assign(6, {});
  spec.machine.joints[1].torsion = 1e8;
  spec.machine.link_springs = {{1, 2, {-0.1, 0, 0.9}, {0.4, 0, 1.4}, 2000.0, 1000.0}};
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const double at_zero = simulation::equilibrium(machine, JointVector::Zero(6)).deformation[0];
  EXPECT_NEAR(at_zero, -500.0 / std::sqrt(2.0) / 1e8, 1e-4 * 3.5e-6);  // its own rate, 1e3 of 1e8 Nm/rad
  // With joint 2 at +30 deg the far end is at 0.5 (sin 30, cos 30) m from the axis.
  const double x = 0.5 + 0.25, z = 0.5 * std::cos(M_PI / 6), length = std::hypot(x, z);
  const double tension = 1000.0 + 2000.0 * (length - std::hypot(0.5, 0.5));
  // Torque about +y of a force f at r is r_z f_x - r_x f_z.
  const double torque = tension / length * (z * -x - 0.25 * -z);
  JointVector q = JointVector::Zero(6);
  q[1] = M_PI / 6;
  EXPECT_NEAR(simulation::equilibrium(machine, q).deformation[0], torque / 1e8, 1e-4 * std::abs(torque / 1e8));
}

// 100 bar on 20 cm2 hold 20 kN at 0.6 m. Pulled out by 0.25 m, 0.5 l of 2 l are gone: the absolute pressure is 4/3 of
// what it was, or (4/3)^1.4; pushed out as far it is 4/5.
TEST(SimulationSprings, gasByHand) {
  const PerBody<Eigen::Isometry3d> at_zero(3, Eigen::Isometry3d::Identity());
  PerBody<Eigen::Isometry3d> longer = at_zero;
  longer[2].translation().x() = 0.25;
  LinkSpring spring{1, 2, {0, 0, 0}, {0.6, 0, 0}, 0.0, 0.0, CylinderGas{100e5, 20e-4, 2e-3, 1.0, false}};
  EXPECT_NEAR(springNow(spring, at_zero).pull.x(), 20e3, 1e-9);
  EXPECT_EQ(springNow(spring, at_zero).energy, 0.0);
  const double absolute = 100e5 + 101325.0;
  EXPECT_NEAR(springNow(spring, longer).pull.x(), (absolute * 4 / 3 - 101325.0) * 20e-4, 1e-9);
  spring.gas->exponent = 1.4;
  EXPECT_NEAR(springNow(spring, longer).pull.x(), (absolute * std::pow(4.0 / 3, 1.4) - 101325.0) * 20e-4, 1e-9);
  spring.gas->pushes = true;
  spring.gas->exponent = 1.0;
  EXPECT_NEAR(springNow(spring, at_zero).pull.x(), -20e3, 1e-9);
  EXPECT_NEAR(springNow(spring, longer).pull.x(), -(absolute * 4 / 5 - 101325.0) * 20e-4, 1e-9);
}

TEST(SimulationSprings, gasPullsByTheSlopeOfItsEnergy) {
  for (const bool pushes : {false, true}) {
    for (const double exponent : {1.0, 1.25}) {
      const LinkSpring spring{
          1, 2, {0, 0, 0}, {0.6, 0, 0}, 0.0, 0.0, CylinderGas{100e5, 20e-4, 2e-3, exponent, pushes}};
      const auto at = [&](double x) {
        PerBody<Eigen::Isometry3d> motions(3, Eigen::Isometry3d::Identity());
        motions[2].translation().x() = x;
        return springNow(spring, motions);
      };
      for (const double x : {-0.2, 0.0, 0.3}) {
        const double slope = (at(x + 1e-6).energy - at(x - 1e-6).energy) / 2e-6;
        // Some 1e4 J are rounded to 1e-12, over 2e-6.
        EXPECT_NEAR(at(x).pull.x(), slope, 1e-3) << pushes << exponent << x;
      }
    }
  }
}

TEST(SimulationSprings, aDeclaredOneStandsInTheCampaign) {
  SimulationSpec spec = armSpec();
  spec.machine.link_springs = {
      {1, 2, {-0.2, 0.3, 0.7}, {0.3, 0.3, 1.6}, 3e4, 1.2e4},
      {1, 2, {-0.4, 0.1, 0.9}, {0.3, 0.2, 1.1}, 0, 0, CylinderGas{40e5, 1e-3, 2e-3, 1.3, true}},
      {0, 3, {-0.3, 0, 0.4}, {0.5, 0.1, 1.9}, 2e3, 500.0}};
  EXPECT_TRUE(measureWithoutNoise(buildMachine(spec), spec).robot.balancers.empty());
  spec.machine.link_springs[1].declared = spec.machine.link_springs[2].declared = true;
  const auto balancers = measureWithoutNoise(buildMachine(spec), spec).robot.balancers;
  ASSERT_EQ(balancers.size(), 2u);
  const auto& gas = std::get<robot::GasLaw>(balancers[0].law);
  EXPECT_EQ(gas.pressure_pa, 40e5);
  EXPECT_EQ(gas.exponent, 1.3);
  EXPECT_TRUE(gas.pushes);
  EXPECT_NEAR(gas.length_m, std::sqrt(0.49 + 0.01 + 0.04), 1e-15);
  EXPECT_EQ(balancers[0].from.body, 1);
  EXPECT_EQ(std::get<robot::SpringLaw>(balancers[1].law).tension_n, 500.0);
  EXPECT_EQ(balancers[1].to.in_base_at_zero, Vector3d(0.5, 0.1, 1.9));
}

// A spring from the base to the arm pulls the base as hard as the arm: nothing on the pedestal's own spring.
TEST(SimulationSprings, aSpringToTheBaseLoadsNoFloor) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.base_rotation = Vector3d(1e6, 1e6, 1e6);
  spec.machine.link_springs = {{0, 3, {0.1, 0.3, 0.2}, {0.6, 0.2, 2.1}, 1000.0, 2000.0}};
  const simulation::MachineState state = simulation::equilibrium(simulation::buildMachine(spec), posture());
  ASSERT_TRUE(state.converged);
  EXPECT_LT(state.deformation.head<3>().norm(), 1e-15);
  EXPECT_GT(state.deformation.norm(), 1e-5);
}

// 100 N along the flange's x at 0.2 m above the plate: 100 / kx, and 20 Nm / ky about y.
TEST(SimulationSprings, toolPlateByHand) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.joints.assign(6, {});
  spec.machine.tool_plate = simulation::ToolPlate{{2e7, 3e7, 5e7}, {1e6, 2e6, 3e6}};
  spec.targets = {{"P10", {0.0, 0.0, 0.3}}};
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const Eigen::Matrix3d flange = spec.nominal.base_from_flange_at_zero.linear();
  const simulation::MachineState state = simulation::equilibrium(
      machine, JointVector::Zero(6), simulation::DeadForce{{0, 0, 0.2}, flange * Vector3d(100, 0, 0)});
  const Vector3d moved =
      flange.transpose() *
      (state.targets_in_base[0] - simulation::equilibrium(machine, JointVector::Zero(6)).targets_in_base[0]);
  const double expected = 100.0 / 2e7 + 0.3 * 20.0 / 2e6;
  EXPECT_NEAR(moved.x(), expected, 1e-4 * expected);
  EXPECT_LT(std::abs(moved.y()), 1e-12);
}

// A pedestal that rests on 2e6 Nm/rad to one side and on twice that to the other.
TEST(SimulationSprings, oneSidedContact) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.joints.assign(6, {});
  spec.machine.base_rotation = Vector3d(2e6, 2e6, 2e6);
  spec.machine.base_contacts = {{1, false, 2e6, 0.0}};
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const auto turn = [&](double force) {
    return simulation::equilibrium(machine, JointVector::Zero(6),
                                   simulation::DeadForce{Vector3d::Zero(), Vector3d(0, 0, force)})
        .deformation[1];
  };
  EXPECT_NEAR(turn(-100.0), 2.0 * 100.0 / 2e6, 1e-3 * 1e-4);  // the flange is 2 m out; finite turns
  EXPECT_NEAR(turn(100.0), -2.0 * 100.0 / 4e6, 1e-3 * 1e-4);
}

}  // namespace springs_test

}  // namespace stiffscope
