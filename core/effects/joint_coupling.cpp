#include "core/effects/all.h"

#include <fmt/format.h>

namespace stiffscope::effects {

// Torque at one joint turns another: a compliance c_ab off the diagonal, theta_a += c_ab tau_b, theta_b +=
// c_ab tau_a (symmetric by Maxwell and Betti), one for each pair, fifteen of six joints; of either sign, rad/Nm.
// Torques of own weight and load together.

namespace {

JointAngles jointCouplingAngles(const LinearizationPoint&, const PostureStates& posture, std::size_t i) {
  const JointVector torque = totalTorque(posture[i]);
  const Eigen::Index joints = torque.size();
  JointAngles result = JointAngles::Zero(joints, joints * (joints - 1) / 2);
  Eigen::Index pair = 0;
  for (Eigen::Index a = 0; a < joints; ++a) {
    for (Eigen::Index b = a + 1; b < joints; ++b, ++pair) {
      result(a, pair) = torque[b];
      result(b, pair) = torque[a];
    }
  }
  return result;
}

std::vector<EffectModel> jointCouplingModels(const ModelScope& scope) {
  EffectModel model{.angles = &jointCouplingAngles};
  for (int a = 1; a <= scope.joints; ++a) {
    for (int b = a + 1; b <= scope.joints; ++b)
      model.parts.push_back({fmt::format("joints {} and {}", a, b), {1e-4}, false, "rad/Nm"});
  }
  return {model};
}

}  // namespace

const EffectRecord& jointCoupling() {
  static const EffectRecord record{
      .effect = Effect::joint_coupling, .nature = EffectNature::machine, .models = &jointCouplingModels};
  return record;
}

}  // namespace stiffscope::effects
