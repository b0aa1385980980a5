#include "core/effects/backlash.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::effects {

namespace {

JointAngles angles(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const Vector6d torque = totalTorque(posture[i]);
  JointAngles result = JointAngles::Zero(6, 7);
  for (Eigen::Index j = 0; j < 6; ++j) {
    const double largest = at.largest_torque[j] > 0.0 ? at.largest_torque[j] : 1.0;
    const double part = torque[j] / largest, side = std::tanh(part / at.passage);
    result(j, j) = 0.5 * side;
    result(j, 6) = -0.5 * at.play[j] * (1.0 - side * side) * part / (at.passage * at.passage);
  }
  return result;
}

void settle(WorkingPoint& at, Eigen::VectorXd& own) {
  at.play = own.head<6>();
  at.passage = std::clamp(at.passage + own[6], 0.5 * at.passage, 2.0 * at.passage);
  constexpr double kSharpest = 1e-3, kWidest = 1.0;
  at.passage = std::clamp(at.passage, kSharpest, kWidest);
  own[6] = 0.0;
}

}  // namespace

EffectModel backlash() {
  EffectModel model{Effect::backlash, "", jointParts(20e-3, true, "rad"), 7, nullptr, &angles, &settle};
  model.parts.push_back({"width of the passage", {1.0}, false, "of the largest torque"});
  return model;
}

}  // namespace stiffscope::effects
