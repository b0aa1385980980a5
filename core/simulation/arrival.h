#pragma once

#include "core/simulation/equilibrium.h"
#include "core/simulation/spec.h"

// What depends on how the arm came to a posture: from where, and each joint from which side.

namespace stiffscope::simulation {

/// Where the arm stands and whence it came. The day begins with all joints at zero.
struct Arrival {
  Vector6d from = Vector6d::Zero(), at = Vector6d::Zero();
  Vector6d side = Vector6d::Zero();  ///< sign of each joint's last move; 0 where it has not moved yet

  void moveTo(const Vector6d& q);
};

/// How far each link stands from its motor within its play (LostMotion), rad: half the width, away from the side it
/// came from, or where the torque on the joint is more than its friction, in the sense of that torque (driveTorques,
/// Nm).
Vector6d lostMotions(const MachineSpec& machine, const Arrival& arrival, const Vector6d& torques);
bool hasLostMotion(const MachineSpec& machine);

/// The angles that the controller logs of this arrival (EarlyLog), rad.
Vector6d loggedAngles(const std::optional<EarlyLog>& log, const Arrival& arrival);

}  // namespace stiffscope::simulation
