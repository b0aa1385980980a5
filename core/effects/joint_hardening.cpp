#include "core/effects/all.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace stiffscope::effects {

// Stiffness grows (or drops) with torque: theta_j = c_j tau - h_j tau^3 (even stiffness k(tau), first term
// of its series), or, the other usual form, theta_j = c_j tau - h_j tau |tau|; tau of own weight and load
// together. Parameters h_j of either sign, one a joint: rad/Nm^3 or rad/Nm^2. The further forms are whole
// where the first two are the start of a series: a spring tau = k theta + k_3 theta^3, of which theta = c
// tau g, g + a tau^2 g^3 = 1; and stiffnesses k (1 + a tau^2), k (1 + a |tau|). Their h_j = c_j a_j; the
// shape takes a_j from the working point.
//
// By stages, as gear makers' catalogues give it: theta_j = c_j tau - sum_b h_jb sign(tau) max(|tau| - t_b,
// 0), six knots t_b evenly up to the largest torque T the joint sees; h_jb in rad/Nm. By a smooth curve: the
// compliance is continuous and its slope is by stages, theta_j = c_j tau - sum_b h_jb sign(tau) max(|tau| -
// t_b, 0)^2 / (2 T), knots at 0, T/8, T/4, T/2, closer where gears give way at their first loads; closer
// still they would pass for backlash.

namespace {

using JointArray = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostJoints, 1>;

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
JointArray stiffer(const JointArray& by) { return 1.0 + by.max(-0.5); }

JointAngles cubicSpring(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const JointArray torque = totalTorque(posture[i]).array();
  const JointArray by = (at.harder_by_square.array() * torque.square()).unaryExpr(&bySpring);
  return JointAngles((-torque.cube() * by).matrix().asDiagonal());
}

JointAngles cubicWhole(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const JointArray torque = totalTorque(posture[i]).array();
  const JointArray by = stiffer(at.harder_by_square.array() * torque.square());
  return JointAngles((-torque.cube() / by).matrix().asDiagonal());
}

JointAngles squareWhole(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const JointArray torque = totalTorque(posture[i]).array();
  const JointArray by = stiffer(at.harder_by_size.array() * torque.abs());
  return JointAngles((-torque * torque.abs() / by).matrix().asDiagonal());
}

/// Brings a_j towards h_j / c_j. A stiffness that drops (a < 0) makes the column the larger the
/// further it drops, and h_j is found the smaller: whole steps would swing about a_j, of a strong drop ever wider.
/// `torque`: |tau| or tau^2 where the joint's torque is largest.
void settle(const JointArray& compliance, const JointArray& torque, const Eigen::VectorXd& own, JointVector& harder) {
  for (Eigen::Index j = 0; j < harder.size(); ++j) {
    const double found = compliance[j] > 0.0 ? own[j] / compliance[j] : 0.0;
    const double drop = std::max(0.0, -found * torque[j]);
    harder[j] += (found - harder[j]) / (1.0 + drop);
  }
}

void settleSquare(LinearizationPoint& at, Eigen::VectorXd& own) {
  settle(at.compliance.array(), at.largest_torque.array().square(), own, at.harder_by_square);
}

void settleSize(LinearizationPoint& at, Eigen::VectorXd& own) {
  settle(at.compliance.array(), at.largest_torque.array(), own, at.harder_by_size);
}

EffectModel bySquare(const ModelScope& scope, const char* shape, decltype(EffectModel::angles) angles) {
  return {.shape = shape,
          .parts = jointParts(scope, 1e-6, false, "rad/Nm^3"),
          .most_parts = static_cast<std::size_t>(scope.joints),
          .angles = angles,
          .settle = &settleSquare};
}

EffectModel bySize(const ModelScope& scope, const char* shape, decltype(EffectModel::angles) angles) {
  return {.shape = shape,
          .parts = jointParts(scope, 1e-6, false, "rad/Nm^2"),
          .most_parts = static_cast<std::size_t>(scope.joints),
          .angles = angles,
          .settle = &settleSize};
}

JointAngles cubic(const LinearizationPoint&, const PostureStates& posture, std::size_t i) {
  const JointVector torque = totalTorque(posture[i]);
  return JointAngles((-torque.array().cube()).matrix().asDiagonal());
}

JointAngles square(const LinearizationPoint&, const PostureStates& posture, std::size_t i) {
  const JointVector torque = totalTorque(posture[i]);
  return JointAngles((-torque.cwiseProduct(torque.cwiseAbs())).asDiagonal());
}

constexpr int kKnots = 6, kBends = 4;

JointAngles stages(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const JointVector torque = totalTorque(posture[i]);
  const Eigen::Index joints = torque.size();
  JointAngles result = JointAngles::Zero(joints, joints * kKnots);
  for (Eigen::Index j = 0; j < joints; ++j) {
    for (int b = 0; b < kKnots; ++b) {
      const double knot = at.largest_torque[j] * (b + 1) / (kKnots + 1);
      result(j, kKnots * j + b) = -std::copysign(std::max(std::abs(torque[j]) - knot, 0.0), torque[j]);
    }
  }
  return result;
}

JointAngles smoothCurve(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const JointVector torque = totalTorque(posture[i]);
  const Eigen::Index joints = torque.size();
  JointAngles result = JointAngles::Zero(joints, joints * kBends);
  for (Eigen::Index j = 0; j < joints; ++j) {
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

EffectModel byKnots(const ModelScope& scope, const char* shape, const char* knot, int knots,
                    decltype(EffectModel::angles) angles) {
  constexpr double kMost = 1e-3;  // rad/Nm
  EffectModel model{.shape = shape,
                    .parts = jointParts(scope, kMost, false, "rad/Nm"),
                    .most_parts = static_cast<std::size_t>(scope.joints),
                    .angles = angles};
  for (EffectPart& part : model.parts) {
    part.most.assign(static_cast<std::size_t>(knots), kMost);
    for (int b = 1; b <= knots; ++b) part.names.push_back(fmt::format("{} {} {}", part.detail, knot, b));
  }
  return model;
}

Remark jointHardeningMissing(const CampaignContents& has) {
  if (has.load_steps < 2) return Remark(RemarkId::hardening_needs_two_loads);
  return {};
}

std::vector<EffectModel> jointHardeningModels(const ModelScope& scope) {
  return {bySquare(scope, "stiffness with the square of the torque", &cubic),
          bySize(scope, "stiffness with the size of the torque", &square),
          bySquare(scope, "a spring with a cubic term", &cubicSpring),
          bySquare(scope, "stiffness with the square of the torque, to any size", &cubicWhole),
          bySize(scope, "stiffness with the size of the torque, to any size", &squareWhole),
          byKnots(scope, "by stages of the torque", "stage", kKnots, &stages),
          byKnots(scope, "by a smooth curve of the torque", "bend", kBends, &smoothCurve)};
}

}  // namespace

const EffectRecord& jointHardening() {
  static const EffectRecord record{.effect = Effect::joint_hardening,
                                   .nature = EffectNature::machine,
                                   .missing = &jointHardeningMissing,
                                   .models = &jointHardeningModels};
  return record;
}

}  // namespace stiffscope::effects
