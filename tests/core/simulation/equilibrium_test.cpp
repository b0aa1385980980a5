#include <cmath>
#include "core/numerics/random.h"
#include "core/simulation/rotation.h"
#include "tests/fixtures/simulation_fixture.h"

namespace stiffscope {

using namespace simulation_test;
using Eigen::AngleAxisd;
using Eigen::Vector3d;

namespace equilibrium_test {

/// Rigid kinematics written out a second time, with a small extra turn at one joint, fixed in its body.
Vector3d rigidPoint(const robot::Robot& robot, const JointVector& q, const Vector3d& in_flange, int joint = -1,
                    const Vector3d& extra = Vector3d::Zero()) {
  Vector3d p = robot.base_from_flange_at_zero * in_flange;
  for (int i = 5; i >= 0; --i) {
    const metrology::Line& axis = robot.axes_in_base_at_zero[i];
    Vector3d arm = p - axis.point;
    if (i == joint) arm = AngleAxisd(extra.norm(), extra.normalized()) * arm;
    p = axis.point + AngleAxisd(q[i], axis.direction) * arm;
  }
  return p;
}

/// d point / d (turn of joint i about `direction`), by central differences.
Vector3d column(const robot::Robot& robot, const JointVector& q, const Vector3d& in_flange, int joint,
                const Vector3d& direction) {
  const double h = 1e-4;
  return (rigidPoint(robot, q, in_flange, joint, h * direction) -
          rigidPoint(robot, q, in_flange, joint, -h * direction)) /
         (2 * h);
}

/// J_m C J_w' F over torsion and both tilts of every joint.
Vector3d linearDisplacement(const simulation::SimulationSpec& spec, const JointVector& q, const Vector3d& measured,
                            const simulation::DeadForce& load) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < 6; ++i) {
    const Vector3d axis = spec.nominal.axes_in_base_at_zero[i].direction;
    const Vector3d directions[3] = {axis, axis.unitOrthogonal(), axis.cross(axis.unitOrthogonal())};
    for (int k = 0; k < 3; ++k) {
      const double stiffness = k == 0 ? *spec.machine.joints[i].torsion : *spec.machine.joints[i].bearing;
      const double torque = column(spec.nominal, q, load.point_in_flange, i, directions[k]).dot(load.force_in_base);
      sum += column(spec.nominal, q, measured, i, directions[k]) * torque / stiffness;
    }
  }
  return sum;
}

double energyAt(const simulation::ElasticMachine& machine, const simulation::AppliedLoad& load, Eigen::VectorXd x,
                Eigen::Index k, double step) {
  x[k] += step;
  return simulation::potentialEnergy(machine, posture(), load, x);
}

// A massless arm on the spring of axis 2 alone: the flange stands a = 1.6 m ahead of the axis and b = 1.3 m
// above it, so k t = F (a cos t + b sin t), solved here by bisection.
TEST(SimulationEquilibrium, oneSpringByHand) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.joints.assign(6, {});
  spec.machine.joints[1].torsion = 2e4;  // soft: a turn of several degrees, far from linear
  const double force = 1500.0, a = 1.6, b = 1.3;
  double low = 0.0, high = 1.0;
  for (int n = 0; n < 200; ++n) {
    const double t = 0.5 * (low + high);
    (2e4 * t < force * (a * std::cos(t) + b * std::sin(t)) ? low : high) = t;
  }
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const simulation::MachineState state = simulation::equilibrium(
      machine, JointVector::Zero(6), simulation::DeadForce{Vector3d::Zero(), Vector3d(0, 0, -force)});
  ASSERT_TRUE(state.converged);
  EXPECT_GT(low, 0.1);
  EXPECT_NEAR(state.deformation[0], low, 1e-12);  // the solver's own promise
  const Vector3d flange = state.base_from_flange.translation();
  EXPECT_NEAR(flange.x(), 0.4 + a * std::cos(low) + b * std::sin(low), 1e-11);
  EXPECT_NEAR(flange.z(), 0.9 - a * std::sin(low) + b * std::cos(low), 1e-11);
}

// The forearm, l = 1.3 m from axis 4 to axis 5, as a cantilever with a vertical force F and its moment 0.3 F
// at the tip: u = F l^3/3EI + F l/kGA + 0.3 F l^2/2EI, and r = F l^2/2EI + 0.3 F l/EI.
TEST(SimulationEquilibrium, beamByHand) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.joints.assign(6, {});
  spec.machine.links = {{3, 1e6, std::nullopt, 2e7, std::nullopt}};
  const double force = 1.0, l = 1.3, ei = 1e6, kga = 2e7;
  const double u = force * (l * l * l / (3 * ei) + l / kga + 0.3 * l * l / (2 * ei));
  const double r = force * (l * l / (2 * ei) + 0.3 * l / ei);
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const simulation::MachineState state = simulation::equilibrium(
      machine, JointVector::Zero(6), simulation::DeadForce{Vector3d::Zero(), Vector3d(0, 0, -force)});
  ASSERT_TRUE(state.converged);
  // A micrometre: finite rotations matter to 1e-6 of it only.
  EXPECT_NEAR(2.2 - state.base_from_flange.translation().z(), u + 0.3 * r, 1e-5 * u);
}

TEST(SimulationEquilibrium, gradientIsThatOfTheEnergy) {
  const simulation::ElasticMachine machine = simulation::buildMachine(fullSpec());
  const simulation::AppliedLoad loads[] = {std::monostate{},
                                           simulation::DeadForce{{0.1, 0.05, 0.2}, {300, -200, -1400}},
                                           simulation::AnchoredCable{{0.1, 0.05, 0.2}, {3.0, 1.0, 0.0}, 2000}};
  numerics::RandomStream random(1, "test");
  for (const simulation::AppliedLoad& load : loads) {
    for (const double size : {1e-9, 1e-3, 0.3}) {  // at nothing, at real size, at turns that are not small
      Eigen::VectorXd x(machine.coordinateCount());
      for (double& value : x) value = size * random.normal();
      const Eigen::VectorXd gradient = simulation::energyGradient(machine, posture(), load, x);
      for (Eigen::Index k = 0; k < x.size(); ++k) {
        const double h = 1e-5;
        const double difference = (energyAt(machine, load, x, k, h) - energyAt(machine, load, x, k, -h)) / (2 * h);
        // Energies up to 1e9 J (stiff directions strained by 0.3) are rounded to 1e-16 of themselves, over
        // 2e-5.
        EXPECT_NEAR(gradient[k], difference, 1e-2 + 1e-8 * gradient.cwiseAbs().maxCoeff())
            << "coordinate " << k << " size " << size;
      }
    }
  }
}

TEST(SimulationEquilibrium, gradientVanishesThere) {
  const simulation::ElasticMachine machine = simulation::buildMachine(fullSpec());
  const simulation::DeadForce load{{0.1, 0.05, 0.2}, {0, 0, -1500}};
  const simulation::MachineState state = simulation::equilibrium(machine, posture(), load);
  ASSERT_TRUE(state.converged);
  EXPECT_LT(state.last_step, 1e-12);
  for (Eigen::Index k = 0; k < state.deformation.size(); ++k) {
    const double h = 1e-4;
    const double up = energyAt(machine, load, state.deformation, k, h);
    const double down = energyAt(machine, load, state.deformation, k, -h);
    EXPECT_GT(up + down, 2 * state.energy);  // a minimum
    // Torques are thousands of Nm; the energy, 3e4 J, is rounded to 1e-11 J, over h; and h^2 truncation.
    EXPECT_NEAR((up - down) / (2 * h), 0.0, 1e-3);
  }
}

// The first-order displacement comes from differences of rigid kinematics in this file. What is left must
// shrink with the square of the load.
TEST(SimulationEquilibrium, smallLoadsAreLinear) {
  const simulation::SimulationSpec spec = armSpec();
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const Vector3d measured = spec.targets[1].position_in_flange;
  const simulation::MachineState unloaded = simulation::equilibrium(machine, posture());
  double before = 0.0;
  for (const double force : {16000.0, 8000.0, 4000.0, 2000.0}) {
    const simulation::DeadForce load{{0.1, 0.05, 0.2}, force * Vector3d(0.2, -0.3, -0.93)};
    const simulation::MachineState state = simulation::equilibrium(machine, posture(), load);
    const Vector3d found = state.targets_in_base[1] - unloaded.targets_in_base[1];
    const Vector3d linear = linearDisplacement(spec, posture(), measured, load);
    const double error = (found - linear).norm();
    EXPECT_LT(error, 0.05 * linear.norm());
    if (before > 0.0) {
      EXPECT_NEAR(before / error, 4.0, 0.4);  // third order: a tenth at 16 kN
    }
    before = error;
  }
}

TEST(SimulationEquilibrium, withoutComplianceItIsRigidKinematics) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.joints.assign(6, {});
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const simulation::MachineState state =
      simulation::equilibrium(machine, posture(), simulation::DeadForce{{0, 0, 0}, {0, 0, -1e6}});
  ASSERT_TRUE(state.converged);
  for (int t = 0; t < 3; ++t) {
    const Vector3d rigid = rigidPoint(spec.nominal, posture(), spec.targets[t].position_in_flange);
    EXPECT_LT((state.targets_in_base[t] - rigid).norm(), 1e-14);  // metres, a few roundings
  }
}

TEST(SimulationEquilibrium, rigidGeometryIsTheMachineWithoutCompliance) {
  simulation::SimulationSpec spec = fullSpec();
  spec.machine.joints.assign(6, {});
  spec.machine.links.clear();
  spec.machine.base_rotation.reset();
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const robot::Robot truth = simulation::rigidGeometry(machine);
  const simulation::MachineState state = simulation::equilibrium(machine, posture());
  const Vector3d in_flange = spec.targets[0].position_in_flange;
  const Vector3d point = rigidPoint(truth, posture(), in_flange);
  EXPECT_LT((state.targets_in_base[0] - point).norm(), 1e-14);
  EXPECT_GT((point - rigidPoint(spec.nominal, posture(), in_flange)).norm(), 1e-5);
  // The wrist axes miss each other by the wrist's own sigma (20 um), not by that of the arm (200 um).
  for (int i = 3; i < 5; ++i) {
    const metrology::Line& a = truth.axes_in_base_at_zero[i];
    const metrology::Line& b = truth.axes_in_base_at_zero[i + 1];
    const double miss = std::abs(a.direction.cross(b.direction).normalized().dot(a.point - b.point));
    EXPECT_LT(miss, 8e-5);  // four sigma
    EXPECT_GT(miss, 0.0);
  }
}

// A mass 1 m above one spring: it takes more than m g h = 981 Nm/rad to hold it upright.
TEST(SimulationEquilibrium, refusesAnUnstableRest) {
  simulation::SimulationSpec spec = armSpec();
  spec.machine.joints.assign(6, {});
  spec.machine.joints[1].torsion = 100.0;
  spec.nominal.bodies[2] = {100.0, {0.4, 0.0, 1.9}};
  EXPECT_FALSE(simulation::equilibrium(simulation::buildMachine(spec), JointVector::Zero(6)).converged);
  spec.machine.joints[1].torsion = 2000.0;
  EXPECT_TRUE(simulation::equilibrium(simulation::buildMachine(spec), JointVector::Zero(6)).converged);
}

// At zero, and on both sides of the change from series to closed form.
TEST(SimulationRotation, exponentialAndItsJacobian) {
  const Vector3d axis(0.6, -0.48, 0.64);
  for (const double size : {0.0, 1e-8, 0.0999999, 0.1000001, 1.0, 3.0}) {
    const Vector3d v = size * axis;
    const Eigen::Matrix3d rotation = simulation::rotationExp(v);
    EXPECT_LT((rotation - AngleAxisd(size, axis).toRotationMatrix()).norm(), 1e-14) << size;
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-6;
      const Vector3d dv = h * Vector3d::Unit(k);
      const Eigen::Matrix3d turn =
          (simulation::rotationExp(v + dv) - simulation::rotationExp(v - dv)) / (2 * h) * rotation.transpose();
      const Vector3d rate(turn(2, 1), turn(0, 2), turn(1, 0));
      EXPECT_LT((rate - simulation::leftJacobian(v).col(k)).norm(), 1e-9) << size;  // rounding over h
    }
  }
}

}  // namespace equilibrium_test

}  // namespace stiffscope
