#include "core/simulation/target_motion.h"

namespace stiffscope::simulation {

ReflectorSeats::ReflectorSeats(const std::vector<TrueTarget>& targets)
    : targets_(targets), slipped_(targets.size(), false), shifts_(targets.size(), Eigen::Vector3d::Zero()) {}

const std::vector<Eigen::Vector3d>& ReflectorSeats::under(const Eigen::Vector3d& force_in_flange) {
  const double size = force_in_flange.norm();
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    if (!targets_[t].motion) continue;
    const TargetMotion& motion = *targets_[t].motion;
    switch (motion.kind) {
      case TargetMotion::Kind::proportional:
        shifts_[t] = size / motion.at_force * motion.shift;
        break;
      case TargetMotion::Kind::compliant:
        shifts_[t] = motion.compliance * force_in_flange;
        break;
      case TargetMotion::Kind::slip:
        if (size >= motion.at_force) slipped_[t] = true;
        if (slipped_[t]) shifts_[t] = motion.shift;
        break;
    }
  }
  return shifts_;
}

}  // namespace stiffscope::simulation
