#include "core/effects/joint_coupling.h"

#include <fmt/format.h>

namespace stiffscope::effects {

namespace {

JointAngles angles(const WorkingPoint&, const PostureStates& posture, std::size_t i) {
  const Vector6d torque = totalTorque(posture[i]);
  JointAngles result = JointAngles::Zero(6, 15);
  Eigen::Index pair = 0;
  for (Eigen::Index a = 0; a < 6; ++a) {
    for (Eigen::Index b = a + 1; b < 6; ++b, ++pair) {
      result(a, pair) = torque[b];
      result(b, pair) = torque[a];
    }
  }
  return result;
}

}  // namespace

EffectModel jointCoupling() {
  EffectModel model{Effect::joint_coupling, "", {}, 1, nullptr, &angles};
  for (int a = 1; a <= 6; ++a) {
    for (int b = a + 1; b <= 6; ++b) {
      model.parts.push_back({fmt::format("joints {} and {}", a, b), {1e-4}, false, "rad/Nm"});
    }
  }
  return model;
}

}  // namespace stiffscope::effects
