#include "core/effects/all.h"

#include <fmt/format.h>
#include <cmath>

namespace stiffscope::effects {

// A spring on axis 2 that the model does not have: a torque that depends on q_2, as a spring
// between a point of the column and a point of the arm has it: k (l - l_0) a b sin(phi) / l, smooth in phi =
// q_2 + phi_0 and written as its Fourier series without the constant (a joint zero), T = sum_n S_n sin n q_2
// + C_n cos n q_2, n to 4. It turns joint 2 by c_2 T unloaded, and changes its give under load by c_2
// T'(q_2) c_2 tau_2. S_n, C_n in Nm.

namespace {

constexpr int kHarmonics = 4;

JointAngles gravityCompensatorAngles(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  const double angle = state.turned[1], compliance = at.compliance[1];
  const double give = compliance * state.load_torque[1];
  JointAngles result = JointAngles::Zero(state.joints(), 2 * kHarmonics);
  for (int harmonic = 1; harmonic <= kHarmonics; ++harmonic) {
    const double n = harmonic;
    result(1, 2 * harmonic - 2) = compliance * (std::sin(n * angle) + n * std::cos(n * angle) * give);
    result(1, 2 * harmonic - 1) = compliance * (std::cos(n * angle) - n * std::sin(n * angle) * give);
  }
  return result;
}

/// The torque turns the joint by the compliance of the equations it was found in.
void gravityCompensatorCorrect(const JointVector& compliance, LinearizationPoint& at, Corrections&,
                               Eigen::VectorXd& own) {
  if (compliance[1] <= 0.0 || at.compliance[1] <= 0.0) {
    own.setZero();
    return;
  }
  own *= compliance[1] / at.compliance[1];
  at.compensator = own;
}

Remark gravityCompensatorMissing(const CampaignContents& has) {
  if (!has.weights) return Remark(RemarkId::compensator_needs_masses);
  if (!has.absolute) return Remark(RemarkId::compensator_needs_positions);
  return {};
}

std::vector<EffectModel> gravityCompensatorModels(const ModelScope&) {
  EffectPart part{"", std::vector<double>(2 * kHarmonics, 1e6), false, "Nm"};
  for (int n = 1; n <= kHarmonics; ++n) {
    part.names.push_back(fmt::format("sin {} q2", n));
    part.names.push_back(fmt::format("cos {} q2", n));
  }
  return {{.parts = {part}, .angles = &gravityCompensatorAngles, .correct = &gravityCompensatorCorrect}};
}

}  // namespace

const EffectRecord& gravityCompensator() {
  static const EffectRecord record{.effect = Effect::gravity_compensator,
                                   .nature = EffectNature::machine,
                                   .missing = &gravityCompensatorMissing,
                                   .models = &gravityCompensatorModels};
  return record;
}

}  // namespace stiffscope::effects
