#include "core/simulation/gears.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::simulation {

void Arrival::moveTo(const JointVector& q) {
  from = at;
  at = q;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    if (at[i] != from[i]) side[i] = at[i] > from[i] ? 1.0 : -1.0;
  }
}

JointVector lostMotions(const MachineSpec& machine, const Arrival& arrival, const JointVector& torques) {
  JointVector ahead = JointVector::Zero(torques.size());
  for (std::size_t j = 0; j < machine.joints.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    const std::optional<LostMotion>& play = machine.joints[j].lost_motion;
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

JointVector loggedAngles(const std::optional<EarlyLog>& log, const Arrival& arrival) {
  if (!log) return arrival.at;
  const JointVector lacking = (-log->after * log->time_constants.cwiseInverse()).array().exp();
  return arrival.at - lacking.cwiseProduct(arrival.at - arrival.from);
}

}  // namespace stiffscope::simulation
