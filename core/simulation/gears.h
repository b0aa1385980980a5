#pragma once

#include "core/simulation/equilibrium.h"
#include "core/simulation/spec.h"

// What depends on how the arm came to a posture: from where, and each joint from which side.

namespace stiffscope::simulation {

/// Where the arm stands and whence it came. The day begins with all joints at zero.
struct Arrival {
  JointVector from, at;
  JointVector side;  ///< sign of each joint's last move; 0 where it has not moved yet

  explicit Arrival(int joints) : from(JointVector::Zero(joints)), at(from), side(from) {}

  void moveTo(const JointVector& q);
};

/// How far each link stands from its motor within its play (LostMotion), rad: half the width, away from the side it
/// came from, or where the torque on the joint is more than its friction, in the sense of that torque (driveTorques,
/// Nm).
JointVector lostMotions(const MachineSpec& machine, const Arrival& arrival, const JointVector& torques);
bool hasLostMotion(const MachineSpec& machine);

/// The angles that the controller logs of this arrival (EarlyLog), rad.
JointVector loggedAngles(const std::optional<EarlyLog>& log, const Arrival& arrival);

/// Torque that each joint's drive carries in a state, Nm, in the sense of its positive angle: what the whole load,
/// weight and link springs among it, would do to the link if it were let go,
///   T_i = - dPi/dq_i at fixed elastic coordinates,
/// by central differences of the potential energy, to 1e-5 Nm.
JointVector driveTorques(const ElasticMachine& machine, const MachineState& state, const AppliedLoad& load,
                         Anchors anchors);

/// How far the link runs ahead of its motor under the drive's torque (JointGear), rad.
double windUp(const JointGear& gear, double torque);

/// equilibrium() of a machine with gears, the controller holding `held`. With the link side held (double encoder
/// active) the machine stands at q = held, and the motors at q - windUp(T). Else the motors stand at `held`, and q =
/// held + windUp(T(q)), found in turns: the torque hardly follows the wind-up, so that each turn leaves a hundredth.
/// Without gears it is equilibrium(). `converged` is false where the turns do not settle.
MachineState equilibriumOnGears(const ElasticMachine& machine, const JointVector& held, bool link_side_held,
                                const AppliedLoad& load, Anchors anchors);

}  // namespace stiffscope::simulation
