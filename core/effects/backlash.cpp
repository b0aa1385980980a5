#include "core/effects/all.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::effects {

// Lost motion as a joint's torque passes zero: theta_j += b_j/2 tanh(tau_j / (w T_j)), tau_j of own weight
// and load together, T_j the largest the joint sees. Parameters: b_j (rad, never negative), the whole play of
// each joint (from stop to stop), at most 20 mrad; and, once they are known, a step of the logarithm of the
// width w over which the passage is rounded, one for all joints: where that is too wide, states near zero
// torque stand short of the stops, and b_j comes out too large by a fifth to a third.

namespace {

JointAngles backlashAngles(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const JointVector torque = totalTorque(posture[i]);
  const Eigen::Index joints = torque.size();
  JointAngles result = JointAngles::Zero(joints, joints + 1);
  for (Eigen::Index j = 0; j < joints; ++j) {
    const double largest = at.largest_torque[j] > 0.0 ? at.largest_torque[j] : 1.0;
    const double part = torque[j] / largest, side = std::tanh(part / at.passage);
    result(j, j) = 0.5 * side;
    result(j, joints) = -0.5 * at.play[j] * (1.0 - side * side) * part / at.passage;
  }
  return result;
}

void settleWidth(LinearizationPoint& at, Eigen::VectorXd& own) {
  const Eigen::Index joints = at.compliance.size();  // then the step of the width
  at.play = own.head(joints);
  constexpr double kStride = 1.0, kSharpest = 1e-3;
  constexpr double kWidest = 0.25;  // beyond, it is no passage but a spring that hardens
  at.passage = std::clamp(at.passage * std::exp(std::clamp(own[joints], -kStride, kStride)), kSharpest, kWidest);
  if (at.play.isZero(0.0)) at.passage = LinearizationPoint().passage;
  own[joints] = 0.0;
}

double passageAt(const LinearizationPoint& at) { return at.passage; }

Remark backlashMissing(const CampaignContents& has) {
  if (has.load_steps < 2 && !has.weights) return Remark(RemarkId::backlash_needs_loads_or_masses);
  return {};
}

std::vector<EffectModel> backlashModels(const ModelScope& scope) {
  EffectModel model{.parts = jointParts(scope, 20e-3, true, "rad"),
                    .most_parts = static_cast<std::size_t>(scope.joints) + 1,
                    .angles = &backlashAngles,
                    .settle = &settleWidth,
                    .shapeAt = &passageAt};
  constexpr double kMost = 1.0;  // a stride: what a posture left out would say of it is not to be guessed from far
  model.parts.push_back({.detail = "width of the passage",
                         .most = {kMost},
                         .positive = false,
                         .unit = "of the largest torque",
                         .is_shape = true});
  return {model};
}

}  // namespace

const EffectRecord& backlash() {
  static const EffectRecord record{.effect = Effect::backlash,
                                   .nature = EffectNature::machine,
                                   .missing = &backlashMissing,
                                   .models = &backlashModels};
  return record;
}

}  // namespace stiffscope::effects
