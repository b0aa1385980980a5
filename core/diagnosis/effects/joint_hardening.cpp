#include "core/diagnosis/effects/joint_hardening.h"

namespace stiffscope {

namespace {

JointAngles cubic(const WorkingPoint&, const PostureStates& posture, std::size_t i) {
  const Vector6d torque = totalTorque(posture[i]);
  return Matrix6d((-torque.array().cube()).matrix().asDiagonal());
}

JointAngles square(const WorkingPoint&, const PostureStates& posture, std::size_t i) {
  const Vector6d torque = totalTorque(posture[i]);
  return Matrix6d((-torque.cwiseProduct(torque.cwiseAbs())).asDiagonal());
}

}  // namespace

EffectModel jointHardening() {
  return {Effect::joint_hardening, "stiffness with the square of the torque", jointParts(1e-6, false, "rad/Nm^3"),
          6, nullptr, &cubic};
}

EffectModel jointHardeningLinear() {
  return {Effect::joint_hardening, "stiffness with the size of the torque", jointParts(1e-6, false, "rad/Nm^2"), 6,
          nullptr, &square};
}

}  // namespace stiffscope
