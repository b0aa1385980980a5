#include "core/diagnosis/effects/joint_hardening.h"

#include <algorithm>
#include <cmath>

namespace stiffscope {

namespace {

using Array6d = Eigen::Array<double, 6, 1>;

/// (1 - g) / x of g + x g^3 = 1: 1 where the spring is linear. Down to where it would have no solution.
double bySpring(double x) {
  constexpr double kLeast = -0.14, kLinear = 1e-6;  // -4/27: the spring's torque has its maximum
  x = std::max(x, kLeast);
  if (std::abs(x) < kLinear) return 1.0;
  double g = 1.0;
  constexpr int kRounds = 30;
  for (int round = 0; round < kRounds; ++round) g -= (g + x * g * g * g - 1.0) / (1.0 + 3.0 * x * g * g);
  return (1.0 - g) / x;
}

/// Stiffness over that at no torque; one that drops is followed down to half.
Array6d stiffer(const Array6d& by) { return 1.0 + by.max(-0.5); }

JointAngles cubicSpring(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const Array6d torque = totalTorque(posture[i]).array();
  const Array6d by = (at.harder_by_square.array() * torque.square()).unaryExpr(&bySpring);
  return Matrix6d((-torque.cube() * by).matrix().asDiagonal());
}

JointAngles cubicWhole(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const Array6d torque = totalTorque(posture[i]).array();
  const Array6d by = stiffer(at.harder_by_square.array() * torque.square());
  return Matrix6d((-torque.cube() / by).matrix().asDiagonal());
}

JointAngles squareWhole(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const Array6d torque = totalTorque(posture[i]).array();
  const Array6d by = stiffer(at.harder_by_size.array() * torque.abs());
  return Matrix6d((-torque * torque.abs() / by).matrix().asDiagonal());
}

EffectModel modelOf(const char* shape, const char* unit, decltype(EffectModel::angles) angles) {
  return {Effect::joint_hardening, shape, jointParts(1e-6, false, unit), 6, nullptr, angles};
}

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
  return modelOf("stiffness with the square of the torque", "rad/Nm^3", &cubic);
}

EffectModel jointHardeningLinear() {
  return modelOf("stiffness with the size of the torque", "rad/Nm^2", &square);
}

EffectModel jointHardeningCubicSpring() {
  return modelOf("a spring with a cubic term", "rad/Nm^3", &cubicSpring);
}

EffectModel jointHardeningWhole() {
  return modelOf("stiffness with the square of the torque, to any size", "rad/Nm^3", &cubicWhole);
}

EffectModel jointHardeningLinearWhole() {
  return modelOf("stiffness with the size of the torque, to any size", "rad/Nm^2", &squareWhole);
}

}  // namespace stiffscope
