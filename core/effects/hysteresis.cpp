#include "core/effects/all.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stiffscope::effects {

// Friction: the way back differs from the way out. Each joint is a spring behind a dry friction f_j (Nm),
// the play operator (Prandtl-Ishlinskii; Coulomb): its spring torque x follows the load torque as x <-
// clamp(x, tau - f, tau + f) from one load step to the next, x = 0 unloaded; theta_j = c_j x. Parameter b_j
// = c_j f_j (rad, never negative): the lag once the joint has slipped. The shape depends on f_j: the working
// point has it, 0 meaning small.
//
// Friction that grips by a spring of its own before it slips (Jenkins; many sliders: Iwan 1966), beside the
// joint's: theta_j = c_j (tau - sum_s g_s), g_s <- clamp(g_s + r k_j / n dtheta, -f_s, f_s), with f_s evenly
// spread from little to twice the mean and their sum f_j. The last parameter is a step of the logarithm
// of r, one for all joints, about the working point's.

namespace {

constexpr double kLeastFriction = 1e-3;  // Nm

double frictionOf(const LinearizationPoint& at, Eigen::Index joint) {
  return std::max(at.friction[joint], kLeastFriction);
}

/// A rigid grip: the joint's spring follows the torque only beyond the friction.
JointAngles rigidGrip(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  JointVector lag(at.compliance.size());
  for (Eigen::Index j = 0; j < lag.size(); ++j) {
    const double friction = frictionOf(at, j);
    double spring = 0.0;
    for (std::size_t k = 1; k <= i; ++k) {
      const double torque = posture[k].load_torque[j];
      spring = std::clamp(spring, torque - friction, torque + friction);
    }
    lag[j] = (spring - (i == 0 ? 0.0 : posture[i].load_torque[j])) / friction;
  }
  return JointMatrix(lag.asDiagonal());
}

/// Sliders beside the joint's spring, each held by a spring of its own (Jenkins elements; many of them:
/// Iwan's parallel model). All as torques: `turn` is the joint's angle times its stiffness.
template <int kSliders>
class Sliders {
 public:
  Sliders(double friction, double sticking) : stiffness_(sticking / kSliders) {
    constexpr double kMean = 0.5 * (kSliders + 1);
    for (int s = 0; s < kSliders; ++s) limit_[static_cast<std::size_t>(s)] = friction / kSliders * (s + 1) / kMean;
  }

  /// Torque that friction takes once the joint has gone to equilibrium with `torque`.
  double moveTo(double torque) {
    double turn = turn_;
    constexpr int kRounds = kSliders + 3;  // piecewise linear and concave along the way: one slider a round
    for (int round = 0; round < kRounds; ++round) {
      double held = 0.0, slope = 1.0;
      for (std::size_t s = 0; s < kSliders; ++s) {
        const double force = held_[s] + stiffness_ * (turn - turn_);
        if (std::abs(force) < limit_[s]) slope += stiffness_;
        held += std::clamp(force, -limit_[s], limit_[s]);
      }
      turn += (torque - held - turn) / slope;
    }
    double sum = 0.0;
    for (std::size_t s = 0; s < kSliders; ++s) {
      held_[s] = std::clamp(held_[s] + stiffness_ * (turn - turn_), -limit_[s], limit_[s]);
      sum += held_[s];
    }
    turn_ = turn;
    return sum;
  }

 private:
  double stiffness_;
  std::array<double, kSliders> limit_{}, held_{};
  double turn_ = 0.0;
};

template <int kSliders>
double lagAfter(double friction, double sticking, const PostureStates& posture, std::size_t i, Eigen::Index joint) {
  Sliders<kSliders> sliders(friction, sticking);
  double held = 0.0;
  for (std::size_t k = 1; k <= i; ++k) held = sliders.moveTo(posture[k].load_torque[joint]);
  return -held / friction;
}

template <int kSliders>
JointAngles softGrip(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  constexpr double kStep = 0.05;  // of the logarithm
  const Eigen::Index joints = at.compliance.size();
  JointAngles result = JointAngles::Zero(joints, joints + 1);
  for (Eigen::Index j = 0; j < joints; ++j) {
    const double friction = frictionOf(at, j);
    result(j, j) = lagAfter<kSliders>(friction, at.sticking, posture, i, j);
    const double firmer = lagAfter<kSliders>(friction, at.sticking * std::exp(kStep), posture, i, j);
    const double softer = lagAfter<kSliders>(friction, at.sticking * std::exp(-kStep), posture, i, j);
    result(j, joints) = at.compliance[j] * at.friction[j] * (firmer - softer) / (2.0 * kStep);
  }
  return result;
}

/// Lag over compliance is friction.
void frictionFrom(LinearizationPoint& at, const Eigen::VectorXd& own) {
  for (Eigen::Index j = 0; j < at.friction.size(); ++j)
    at.friction[j] = at.compliance[j] > 0.0 ? own[j] / at.compliance[j] : 0.0;
}

void settleFriction(LinearizationPoint& at, Eigen::VectorXd& own) {
  frictionFrom(at, own);
  const Eigen::Index last = at.compliance.size();
  if (at.friction.isZero(0.0)) at.sticking = LinearizationPoint().sticking;
  if (own.size() == last) return;  // a rigid grip
  constexpr double kStride = 1.0, kSoftest = 0.05, kFirmest = 20.0;
  at.sticking = std::clamp(at.sticking * std::exp(std::clamp(own[last], -kStride, kStride)), kSoftest, kFirmest);
  own[last] = 0.0;
}

double firmnessAt(const LinearizationPoint& at) { return at.sticking; }

EffectModel softModel(const ModelScope& scope, const char* shape, decltype(EffectModel::angles) angles) {
  EffectModel model{.shape = shape,
                    .parts = jointParts(scope, 20e-3, true, "rad"),
                    .most_parts = static_cast<std::size_t>(scope.joints) + 1,
                    .angles = angles,
                    .settle = &settleFriction,
                    .shapeAt = &firmnessAt};
  constexpr double kMost = 5.0;
  model.parts.push_back({.detail = "firmness of the grip",
                         .most = {kMost},
                         .positive = false,
                         .unit = "of the joint's stiffness",
                         .is_shape = true});
  return model;
}

Remark hysteresisMissing(const CampaignContents& has) {
  if (!has.return_to_zero) return Remark(RemarkId::hysteresis_needs_return_to_zero);
  return {};
}

std::vector<EffectModel> hysteresisModels(const ModelScope& scope) {
  return {{.shape = "a rigid grip",
           .parts = jointParts(scope, 20e-3, true, "rad"),
           .most_parts = static_cast<std::size_t>(scope.joints),
           .angles = &rigidGrip,
           .settle = &settleFriction},
          softModel(scope, "a slider held by a spring", &softGrip<1>),
          softModel(scope, "many sliders held by springs", &softGrip<8>)};
}

}  // namespace

const EffectRecord& hysteresis() {
  static const EffectRecord record{.effect = Effect::hysteresis,
                                   .nature = EffectNature::machine,
                                   .missing = &hysteresisMissing,
                                   .models = &hysteresisModels};
  return record;
}

}  // namespace stiffscope::effects
