#include "core/diagnosis/effects/backlash.h"

#include <algorithm>
#include <cmath>

namespace stiffscope {

namespace {

JointAngles angles(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const Vector6d torque = totalTorque(posture[i]);
  JointAngles result = JointAngles::Zero(6, 7);
  for (Eigen::Index j = 0; j < 6; ++j) {
    const double side = std::tanh(torque[j] / at.passage);
    result(j, j) = 0.5 * side;
    result(j, 6) = -0.5 * at.play[j] * (1.0 - side * side) * torque[j] / (at.passage * at.passage);
  }
  return result;
}

void settle(WorkingPoint& at, Eigen::VectorXd& own) {
  at.play = own.head<6>();
  at.passage = std::clamp(at.passage + own[6], 1.0, 1000.0);
  own[6] = 0.0;
}

}  // namespace

EffectModel backlash() {
  EffectModel model{Effect::backlash, "", jointParts(20e-3, true, "rad"), 7, nullptr, &angles, &settle};
  model.parts.push_back({"width of the passage", {100.0}, false, "Nm"});
  return model;
}

}  // namespace stiffscope
