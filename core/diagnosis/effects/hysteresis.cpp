#include "core/diagnosis/effects/hysteresis.h"

#include <algorithm>

namespace stiffscope {

namespace {

JointAngles angles(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  constexpr double kLeast = 1e-3;  // Nm
  Vector6d lag;
  for (Eigen::Index j = 0; j < 6; ++j) {
    const double friction = std::max(at.friction[j], kLeast);
    double spring = 0.0;
    for (std::size_t k = 1; k <= i; ++k) {
      const double torque = posture[k].load_torque[j];
      spring = std::clamp(spring, torque - friction, torque + friction);
    }
    lag[j] = (spring - (i == 0 ? 0.0 : posture[i].load_torque[j])) / friction;
  }
  return Matrix6d(lag.asDiagonal());
}

}  // namespace

EffectModel hysteresis() { return {Effect::hysteresis, "", jointParts(20e-3, true, "rad"), 6, nullptr, &angles}; }

}  // namespace stiffscope
