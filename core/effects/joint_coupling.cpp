#include "core/effects/all.h"

#include <fmt/format.h>

namespace stiffscope::effects {

// Torque at one joint turns another: a compliance c_ab off the diagonal, theta_a += c_ab tau_b, theta_b +=
// c_ab tau_a (symmetric by Maxwell and Betti), one for each of the fifteen pairs; of either sign, rad/Nm.
// Torques of own weight and load together.

namespace {

JointAngles jointCouplingAngles(const LinearizationPoint&, const PostureStates& posture, std::size_t i) {
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

std::vector<EffectModel> jointCouplingModels(const std::vector<std::string>&) {
  EffectModel model{.angles = &jointCouplingAngles};
  for (int a = 1; a <= 6; ++a) {
    for (int b = a + 1; b <= 6; ++b)
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
