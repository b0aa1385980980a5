#include "core/simulation/gears.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::simulation {

void Arrival::moveTo(const Vector6d& q) {
  from = at;
  at = q;
  for (int i = 0; i < 6; ++i) {
    if (at[i] != from[i]) side[i] = at[i] > from[i] ? 1.0 : -1.0;
  }
}

Vector6d lostMotions(const MachineSpec& machine, const Arrival& arrival, const Vector6d& torques) {
  Vector6d ahead = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const std::optional<LostMotion>& play = machine.joints[static_cast<std::size_t>(i)].lost_motion;
    if (!play) continue;
    const bool pulled = play->friction && std::abs(torques[i]) > *play->friction;
    ahead[i] = 0.5 * play->width * (pulled ? std::copysign(1.0, torques[i]) : -arrival.side[i]);
  }
  return ahead;
}

bool hasLostMotion(const MachineSpec& machine) {
  return std::any_of(machine.joints.begin(), machine.joints.end(),
                     [](const JointStiffness& joint) { return joint.lost_motion.has_value(); });
}

Vector6d loggedAngles(const std::optional<EarlyLog>& log, const Arrival& arrival) {
  if (!log) return arrival.at;
  const Vector6d lacking = (-log->after * log->time_constants.cwiseInverse()).array().exp();
  return arrival.at - lacking.cwiseProduct(arrival.at - arrival.from);
}

}  // namespace stiffscope::simulation
