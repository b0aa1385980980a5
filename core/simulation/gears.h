#pragma once

#include "core/simulation/equilibrium.h"

namespace stiffscope::simulation {

/// Torque that each joint's drive carries in a state, Nm, in the sense of its positive angle: what the whole load,
/// weight and link springs among it, would do to the link if it were let go,
///   T_i = - dPi/dq_i at fixed elastic coordinates,
/// by central differences of the potential energy, to 1e-5 Nm.
Vector6d driveTorques(const ElasticMachine& machine, const MachineState& state, const AppliedLoad& load,
                      Anchors anchors);

/// How far the link runs ahead of its motor under the drive's torque (JointGear), rad.
double windUp(const JointGear& gear, double torque);

/// equilibrium() of a machine with gears, the controller holding `held`. With the link side held (double encoder
/// active) the machine stands at q = held, and the motors at q - windUp(T). Else the motors stand at `held`, and q =
/// held + windUp(T(q)), found in turns: the torque hardly follows the wind-up, so that each turn leaves a hundredth.
/// Without gears it is equilibrium(). `converged` is false where the turns do not settle.
MachineState equilibriumOnGears(const ElasticMachine& machine, const Vector6d& held, bool link_side_held,
                                const AppliedLoad& load, Anchors anchors);

}  // namespace stiffscope::simulation
