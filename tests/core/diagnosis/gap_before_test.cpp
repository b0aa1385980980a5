#include <gtest/gtest.h>

#include <cmath>
#include "core/diagnosis/diagnose.h"
#include "tests/fixtures/extended_day.h"

namespace stiffscope {
namespace gap_before_test {

// What stiffnesses alone leave must not depend on which effects were found later. An effect that corrects the wrench or
// the places moves the equations themselves: a zero parameter in the corrected ones is not a machine without it.
TEST(Diagnose, GapBeforeIsThatOfADiagnosisThatFindsNothing) {
  simulation::SimulationSpec spec = springsAlone(5);
  spec.load_cell->place_error = {0.10, -0.06, 0.12};
  spec.load_cell->misalignment = {0.05, -0.08, 0.03};
  const campaign::Campaign campaign = simulation::simulate(spec);
  diagnosis::DiagnoseOptions quick;
  quick.resamples = 0;
  quick.chance_draws = 20;
  const diagnosis::Diagnosis found = diagnosis::diagnose(campaign, quick);
  diagnosis::DiagnoseOptions blunt = quick;
  blunt.deflection_share = 10.0;  // nothing is large enough to matter
  const diagnosis::Diagnosis nothing = diagnosis::diagnose(campaign, blunt);
  ASSERT_GE(found.verdict.entries.size(), 2u);
  ASSERT_GT(nothing.gap.after, 0.99 * nothing.gap.before) << "something was found";
  ASSERT_LT(found.gap.after, 0.2 * found.gap.before);
  EXPECT_NEAR(found.gap.before, nothing.gap.before, 1e-6 * nothing.gap.before);
  for (int joint = 0; joint < 6; ++joint)
    EXPECT_NEAR(found.stiffness_before[joint], nothing.stiffness_before[joint],
                1e-6 * std::abs(nothing.stiffness_before[joint]));
}

}  // namespace gap_before_test
}  // namespace stiffscope
