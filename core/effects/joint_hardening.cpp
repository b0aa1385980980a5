#include "core/effects/joint_hardening.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::effects {

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

/// a_j = h_j / c_j.
Vector6d overCompliance(const WorkingPoint& at, const Eigen::VectorXd& own) {
  return (at.compliance.array() > 0.0).select(own.array() / at.compliance.array(), 0.0);
}

void settleSquare(WorkingPoint& at, Eigen::VectorXd& own) { at.harder_by_square = overCompliance(at, own); }

void settleSize(WorkingPoint& at, Eigen::VectorXd& own) { at.harder_by_size = overCompliance(at, own); }

EffectModel bySquare(const char* shape, decltype(EffectModel::angles) angles) {
  return {Effect::joint_hardening, shape,  jointParts(1e-6, false, "rad/Nm^3"), 6, nullptr,
          angles,                  &settleSquare};
}

EffectModel bySize(const char* shape, decltype(EffectModel::angles) angles) {
  return {Effect::joint_hardening, shape, jointParts(1e-6, false, "rad/Nm^2"), 6, nullptr, angles,
          &settleSize};
}

JointAngles cubic(const WorkingPoint&, const PostureStates& posture, std::size_t i) {
  const Vector6d torque = totalTorque(posture[i]);
  return Matrix6d((-torque.array().cube()).matrix().asDiagonal());
}

JointAngles square(const WorkingPoint&, const PostureStates& posture, std::size_t i) {
  const Vector6d torque = totalTorque(posture[i]);
  return Matrix6d((-torque.cwiseProduct(torque.cwiseAbs())).asDiagonal());
}

constexpr int kKnots = 6, kBends = 4;

JointAngles stages(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const Vector6d torque = totalTorque(posture[i]);
  JointAngles result = JointAngles::Zero(6, 6 * kKnots);
  for (Eigen::Index j = 0; j < 6; ++j) {
    for (int b = 0; b < kKnots; ++b) {
      const double knot = at.largest_torque[j] * (b + 1) / (kKnots + 1);
      result(j, kKnots * j + b) = -std::copysign(std::max(std::abs(torque[j]) - knot, 0.0), torque[j]);
    }
  }
  return result;
}

JointAngles smoothCurve(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const Vector6d torque = totalTorque(posture[i]);
  JointAngles result = JointAngles::Zero(6, 6 * kBends);
  for (Eigen::Index j = 0; j < 6; ++j) {
    const double largest = at.largest_torque[j];
    if (!(largest > 0.0)) continue;
    for (int b = 0; b < kBends; ++b) {
      const double knot = b == 0 ? 0.0 : std::ldexp(largest, b - kBends);
      const double over = std::max(std::abs(torque[j]) - knot, 0.0);
      result(j, kBends * j + b) = -std::copysign(0.5 * over * over / largest, torque[j]);
    }
  }
  return result;
}

EffectModel byKnots(const char* shape, int knots, decltype(EffectModel::angles) angles) {
  constexpr double kMost = 1e-3;  // rad/Nm
  EffectModel model{Effect::joint_hardening, shape, jointParts(kMost, false, "rad/Nm"), 6, nullptr, angles};
  for (EffectPart& part : model.parts) part.most.assign(static_cast<std::size_t>(knots), kMost);
  return model;
}

}  // namespace

EffectModel jointHardening() { return bySquare("stiffness with the square of the torque", &cubic); }

EffectModel jointHardeningLinear() { return bySize("stiffness with the size of the torque", &square); }

EffectModel jointHardeningCubicSpring() { return bySquare("a spring with a cubic term", &cubicSpring); }

EffectModel jointHardeningWhole() {
  return bySquare("stiffness with the square of the torque, to any size", &cubicWhole);
}

EffectModel jointHardeningLinearWhole() {
  return bySize("stiffness with the size of the torque, to any size", &squareWhole);
}

EffectModel jointHardeningByStages() { return byKnots("by stages of the torque", kKnots, &stages); }

EffectModel jointHardeningSmooth() { return byKnots("by a smooth curve of the torque", kBends, &smoothCurve); }

}  // namespace stiffscope::effects
