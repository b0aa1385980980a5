#include "core/diagnosis/linear_system.h"

#include <gtest/gtest.h>
#include "core/diagnosis/projection.h"
#include "tests/fixtures/extended_day.h"

namespace stiffscope {
namespace linear_system_test {

// Weighing anew is what making the equations anew with other variances comes to, to the last bit.
TEST(LinearSystem, IsWeighedAgainAsItIsMadeAgain) {
  const campaign::Campaign campaign = simulation::simulate(springsAlone(8));
  const extended_model::EffectFit effects =
      extended_model::fitEffects(campaign, extended_model::requestedEffects({"bearing_tilt:3"}, campaign));
  const diagnosis::SystemInput& input = *effects.input;
  diagnosis::SystemState state = effects.fit.state;
  ASSERT_TRUE(input.absolute && input.sweeps);
  diagnosis::LinearSystem data = diagnosis::linearSystem(input, state, {}, diagnosis::Weighed::again);
  const std::vector<double> ones(data.postures.size(), 1.0);
  const Eigen::MatrixXd before = diagnosis::sumOf(data, ones);
  state.position_inflation *= 1.7;
  state.sweep_inflation *= 2.5;
  state.model_error += 1e-5;
  diagnosis::weighAgain(input, state, data);
  const diagnosis::LinearSystem made = diagnosis::linearSystem(input, state, {});
  EXPECT_EQ(diagnosis::sumOf(data, ones), diagnosis::sumOf(made, ones));
  EXPECT_NE(diagnosis::sumOf(data, ones), before);
  EXPECT_EQ(data.sweep_rows, made.sweep_rows);
  EXPECT_EQ(data.state_noise, made.state_noise);
  EXPECT_EQ(data.as_read.rows.size(), 0);
}

}  // namespace linear_system_test
}  // namespace stiffscope
