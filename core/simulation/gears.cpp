#include "core/simulation/gears.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::simulation {

JointVector driveTorques(const ElasticMachine& machine, const MachineState& state, const AppliedLoad& load,
                         Anchors anchors) {
  constexpr double kStep = 1e-4;  // rad
  const Eigen::Index joints = machine.joints();
  JointVector torques(joints);
  for (Eigen::Index i = 0; i < joints; ++i) {
    const JointVector step = kStep * JointVector::Unit(joints, i);
    const double ahead = potentialEnergy(machine, state.q + step, load, state.deformation, anchors);
    const double behind = potentialEnergy(machine, state.q - step, load, state.deformation, anchors);
    torques[i] = (behind - ahead) / (2.0 * kStep);
  }
  return torques;
}

double windUp(const JointGear& gear, double torque) {
  constexpr double kCrossing = 10.0;  // Nm: a step would leave a link that hangs in the gap without an equilibrium
  return torque / gear.stiffness + 0.5 * gear.lost_motion * std::clamp(torque / kCrossing, -1.0, 1.0);
}

namespace {

bool hasGears(const ElasticMachine& machine) {
  return std::any_of(machine.truth.joints.begin(), machine.truth.joints.end(),
                     [](const JointStiffness& joint) { return joint.gear.has_value(); });
}

JointVector windUps(const ElasticMachine& machine, const JointVector& torques) {
  JointVector ahead = JointVector::Zero(machine.joints());
  for (int i = 0; i < machine.joints(); ++i) {
    const JointStiffness& joint = machine.truth.joints[static_cast<std::size_t>(i)];
    if (joint.gear) ahead[i] = windUp(*joint.gear, torques[i]);
  }
  return ahead;
}

}  // namespace

MachineState equilibriumOnGears(const ElasticMachine& machine, const JointVector& held, bool link_side_held,
                                const AppliedLoad& load, Anchors anchors) {
  MachineState state = equilibrium(machine, held, load, anchors);
  state.held = state.motor_side = held;
  if (!hasGears(machine) || !state.converged) return state;
  JointVector ahead = windUps(machine, driveTorques(machine, state, load, anchors));
  if (link_side_held) {
    state.motor_side = held - ahead;
    return state;
  }
  constexpr double kSettled = 1e-11;  // rad
  constexpr int kMostTurns = 30;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    state = equilibrium(machine, held + ahead, load, anchors);
    state.held = state.motor_side = held;
    if (!state.converged) return state;
    const JointVector next = windUps(machine, driveTorques(machine, state, load, anchors));
    const double change = (next - ahead).cwiseAbs().maxCoeff();
    ahead = next;
    if (change < kSettled) return state;
  }
  state.converged = false;
  return state;
}

}  // namespace stiffscope::simulation
