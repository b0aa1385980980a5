#include <gtest/gtest.h>

#include <cmath>
#include "core/diagnosis/held_out.h"
#include "core/effects/all.h"

// What a campaign lacks makes effects not testable, with what is missing; and shrinks from squares
// by posture.

namespace stiffscope {
namespace preconditions_test {

effects::CampaignContents everything() {
  effects::CampaignContents has;
  has.reflectors = 3;
  has.load_steps = 3;
  has.return_to_zero = has.moments = has.times = has.weights = has.absolute = has.sweeps = has.nests = true;
  has.carriage_positions = 3;
  return has;
}

bool says(effects::Effect effect, const effects::CampaignContents& has, effects::RemarkId what) {
  return effects::missingFor(effect, has).is(what);
}

TEST(Testable, NothingIsMissingFromAFullDay) {
  for (std::size_t e = 0; e < effects::kEffectCount; ++e) {
    EXPECT_TRUE(effects::missingFor(static_cast<effects::Effect>(e), everything()).empty()) << effects::kEffectIds[e];
  }
}

TEST(Testable, SaysWhatIsMissing) {
  effects::CampaignContents one_step = everything();
  one_step.load_steps = 1;
  EXPECT_TRUE(says(effects::Effect::joint_hardening, one_step, effects::RemarkId::hardening_needs_two_loads));
  EXPECT_TRUE(says(effects::Effect::load_cell_bias, one_step, effects::RemarkId::bias_needs_two_loads));
  EXPECT_TRUE(effects::missingFor(effects::Effect::bearing_tilt, one_step).empty());
  effects::CampaignContents no_return = everything();
  no_return.return_to_zero = false;
  EXPECT_TRUE(says(effects::Effect::hysteresis, no_return, effects::RemarkId::hysteresis_needs_return_to_zero));
  effects::CampaignContents two_reflectors = everything();
  two_reflectors.reflectors = 2;
  EXPECT_TRUE(says(effects::Effect::target_motion, two_reflectors, effects::RemarkId::target_needs_three_reflectors));
  effects::CampaignContents no_masses = everything();
  no_masses.weights = no_masses.absolute = false;
  EXPECT_TRUE(says(effects::Effect::gravity_compensator, no_masses, effects::RemarkId::compensator_needs_masses));
  EXPECT_TRUE(says(effects::Effect::kinematic_error, no_masses, effects::RemarkId::geometry_needs_masses));
  effects::CampaignContents no_sweeps = everything();
  no_sweeps.sweeps = false;
  EXPECT_TRUE(says(effects::Effect::frame_error, no_sweeps, effects::RemarkId::frame_needs_sweeps_and_positions));
  effects::CampaignContents two_positions = everything();
  two_positions.carriage_positions = 2;
  EXPECT_TRUE(
      says(effects::Effect::rail_bending, two_positions, effects::RemarkId::rail_bending_needs_three_positions));
  effects::CampaignContents no_rail = everything();
  no_rail.carriage_positions = 0;
  EXPECT_TRUE(says(effects::Effect::rail_bending, no_rail, effects::RemarkId::rail_bending_needs_rail));
  effects::CampaignContents no_nests = everything();
  no_nests.nests = no_nests.absolute = false;
  EXPECT_TRUE(says(effects::Effect::tracker_drift, no_nests, effects::RemarkId::drift_needs_nests_or_timed_positions));
}

// Twelve postures that all halve: 0.5, without any spread. One that does not shrink among them: the interval
// holds the value and is as wide as drawing it or not makes it.
TEST(Shrink, IsThatOfRootMeanSquares) {
  std::vector<diagnosis::HeldOut> postures(12, {4.0, 1.0, 9.0, 9.0});
  const diagnosis::HeldOutShrink even = diagnosis::shrinkOver(postures, 200, 1);
  EXPECT_DOUBLE_EQ(even.deflection.value, 0.5);
  EXPECT_DOUBLE_EQ(even.deflection.low, 0.5);
  EXPECT_DOUBLE_EQ(even.position.value, 0.0);
  postures.front() = {4.0, 4.0, 9.0, 9.0};
  const diagnosis::HeldOutShrink mixed = diagnosis::shrinkOver(postures, 400, 1);
  EXPECT_NEAR(mixed.deflection.value, 1.0 - std::sqrt(15.0 / 48.0), 1e-12);
  EXPECT_LT(mixed.deflection.low, mixed.deflection.value);
  EXPECT_GT(mixed.deflection.high, mixed.deflection.value);
  EXPECT_LE(mixed.deflection.high,
            0.5 + 0.05);  // not drawn at all: all halve; the median may stand a little off the value
}

}  // namespace preconditions_test
}  // namespace stiffscope
