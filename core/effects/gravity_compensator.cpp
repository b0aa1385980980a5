#include "core/effects/gravity_compensator.h"

#include <cmath>

namespace stiffscope::effects {

namespace {

constexpr int kHarmonics = 4;

JointAngles angles(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  const double angle = state.turned[1], compliance = at.compliance[1];
  const double give = compliance * state.load_torque[1];
  JointAngles result = JointAngles::Zero(6, 2 * kHarmonics);
  for (int harmonic = 1; harmonic <= kHarmonics; ++harmonic) {
    const double n = harmonic;
    result(1, 2 * harmonic - 2) = compliance * (std::sin(n * angle) + n * std::cos(n * angle) * give);
    result(1, 2 * harmonic - 1) = compliance * (std::cos(n * angle) - n * std::sin(n * angle) * give);
  }
  return result;
}

}  // namespace

EffectModel gravityCompensator() {
  return {Effect::gravity_compensator,
          "",
          {{"", std::vector<double>(2 * kHarmonics, 1e6), false, "Nm"}},
          1,
          nullptr,
          &angles};
}

}  // namespace stiffscope::effects
