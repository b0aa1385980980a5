#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/effects/all.h"
#include "core/extended_model/effect_fit.h"
#include "core/extended_model/requested_effects.h"
#include "core/simulation/measure.h"
#include "tests/fixtures/extended_day.h"

// How large a lost motion is stated. The simulator's joint gives way between two stops within some newton metres: near
// zero torque no width of the passage but its own leaves the size as it is.

namespace stiffscope {
namespace backlash_size_test {

constexpr double kWidth = 250e-6;  // rad, from stop to stop

simulation::SimulationSpec withPlay(std::uint64_t seed) {
  simulation::SimulationSpec spec = springsAlone(seed);
  spec.machine.joints[4].backlash = simulation::JointBacklash{kWidth};
  return spec;
}

const extended_model::EffectParameter& parameterOf(const extended_model::EffectFit& fit, const std::string& name) {
  const auto& parameters = fit.added.front().parameters;
  return *std::find_if(parameters.begin(), parameters.end(),
                       [&](const extended_model::EffectParameter& one) { return one.name == name; });
}

// Fitted at the width with which the equations begin, a twentieth of the largest torque, it is a fifth too large.
TEST(BacklashSize, IsThatOfTheMachineWhereTheJointIsNamed) {
  for (const std::uint64_t seed : {4, 5}) {
    const campaign::Campaign campaign = simulation::simulate(withPlay(seed));
    const extended_model::EffectFit fit =
        extended_model::fitEffects(campaign, extended_model::requestedEffects({"backlash:5"}, campaign));
    ASSERT_EQ(fit.added.size(), 1u);
    EXPECT_EQ(fit.added.front().detail, "joint 5");
    ASSERT_EQ(fit.added.front().parameters.size(), 2u);
    const extended_model::EffectParameter& size = parameterOf(fit, "joint 5");
    const extended_model::EffectParameter& width = parameterOf(fit, "width of the passage");
    EXPECT_NEAR(size.value, kWidth, 0.08 * kWidth) << seed;
    EXPECT_LT(std::abs(size.value - kWidth), 3.5 * size.sd) << seed;
    EXPECT_GT(width.value, 0.0) << seed;
    EXPECT_LT(width.value, 0.02) << seed;
  }
}

// A shape is a step of a logarithm: its column is the derivative of the angles by it, of every effect that has one.
TEST(EffectShapes, ColumnsAreTheDerivativesByTheLogarithm) {
  const effects::ModelScope scope{.joints = 6, .targets = {"A"}};
  for (const effects::EffectModel& model : effects::effectModels(scope)) {
    const bool has = std::any_of(model.parts.begin(), model.parts.end(),
                                 [](const effects::EffectPart& part) { return part.is_shape; });
    EXPECT_EQ(has, model.shapeAt != nullptr) << model.shape;
  }
  const effects::EffectModel play = effects::modelsOf(effects::backlash(), scope).front();
  effects::LinearizationPoint at(6);
  at.largest_torque.setConstant(100.0);
  at.play.setConstant(kWidth);
  at.passage = 0.1;
  effects::ArmState state;
  state.load_torque = JointVector::LinSpaced(6, -20.0, 30.0);
  state.weight_torque = JointVector::Zero(6);
  const effects::PostureStates posture{state};
  const auto turned = [&](double step) {
    effects::LinearizationPoint moved = at;
    moved.passage = at.passage * std::exp(step);
    return JointVector(play.angles(moved, posture, 0).leftCols(6) * at.play);
  };
  constexpr double kStep = 1e-4;
  const JointVector by_step = (turned(kStep) - turned(-kStep)) / (2.0 * kStep);
  EXPECT_LT((play.angles(at, posture, 0).col(6) - by_step).norm(), 1e-6 * by_step.norm());
  EXPECT_GT(by_step.norm(), 0.1 * kWidth);
}

}  // namespace backlash_size_test
}  // namespace stiffscope
