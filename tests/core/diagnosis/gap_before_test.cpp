#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/gap_study.h"
#include "core/diagnosis/held_out.h"
#include "core/diagnosis/localization.h"
#include "core/preparation/prepare.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/extended_day.h"
#include "tests/fixtures/station_day.h"

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

/// Squares by posture, summed.
diagnosis::HeldOut summed(const std::vector<diagnosis::HeldOut>& postures) {
  diagnosis::HeldOut sum;
  for (const diagnosis::HeldOut& one : postures) {
    sum.deflection_before += one.deflection_before;
    sum.deflection_after += one.deflection_after;
  }
  return sum;
}

// Where the station's motion was taken off, too, the shrink is that in postures that took no part in the fit. These are
// predicted worse than fitted: before, by stiffnesses that know nothing of the station, as well as after.
TEST(Diagnose, TheShrinkOfAMovedStationIsThatOfPosturesHeldOut) {
  simulation::SimulationSpec spec = springsAlone(5);
  spec.timing.nest_interval_s = 1200.0;
  spec.station.ramp.head<3>() << 1e-7, 0.0, 5e-8;  // m/s
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(spec));
  const diagnosis::GapStudy study = diagnosis::studyGap(prepared);
  ASSERT_FALSE(study.given.empty()) << "no motion was taken off";
  const diagnosis::GapFit& fit = study.fit;
  const diagnosis::GapFit alone = diagnosis::withoutEffects(*study.input, study.start->state, fit);
  const Eigen::VectorXd after = diagnosis::allParameters(fit.nuisances, fit.set.effects);
  const auto leftBy = [&](const std::vector<Eigen::VectorXd>& after_without) {
    return *diagnosis::gapAsMeasured(prepared, *study.input, fit, after, after_without);
  };
  const diagnosis::GapAsMeasured fitted = leftBy(std::vector<Eigen::VectorXd>(fit.data->postures.size(), after));
  const diagnosis::GapAsMeasured gap =
      leftBy(diagnosis::parametersWithoutEach(*study.input, alone, fit, study.allowed));
  const diagnosis::HeldOut held_out = summed(gap.left);
  double rows = 0.0;
  for (const diagnosis::GapPosture& posture : fit.data->postures)
    rows += static_cast<double>(posture.right.size() - posture.position_rows);
  diagnosis::DiagnoseOptions quick;
  quick.resamples = 4;
  quick.chance_draws = 20;
  const double shrink = diagnosis::diagnose(prepared, study, quick).shrink_together.value;
  EXPECT_GT(held_out.deflection_before, 1.002 * rows * *gap.deflection * *gap.deflection);
  EXPECT_GT(held_out.deflection_after, 1.002 * summed(fitted.left).deflection_after);
  EXPECT_NEAR(shrink, 1.0 - std::sqrt(held_out.deflection_after / held_out.deflection_before), 1e-9);
}

/// Loaded readings off along the beam that they were read by, to and fro as no stiffness moves them.
void spoilAlongBeam(campaign::Campaign& day, double size) {
  for (campaign::LoadingReading& row : day.loading->rows) {
    if (row.step == 0) continue;
    const double sign = (row.pose + row.step) % 2 == 0 ? 1.0 : -1.0;
    row.point += sign * size * row.point.normalized();  // the tracker stands at its own frame's origin
  }
}

// Of two trackers each has its own beam: what is off along it is nothing across it.
TEST(Diagnose, ABeamIsThatOfTheStationThatRead) {
  campaign::Campaign day = seenFromTwo(simulation::simulate(springsAlone(5)), 10);
  spoilAlongBeam(day, 60e-6);
  diagnosis::DiagnoseOptions quick;
  quick.resamples = 0;
  quick.chance_draws = 20;
  const diagnosis::Diagnosis found = diagnosis::diagnose(day, quick);
  ASSERT_TRUE(found.usable) << reports::words(found.unusable_reason);
  const auto beam = std::find_if(found.where.begin(), found.where.end(),
                                 [](const diagnosis::WhereTable& table) { return table.by == "tracker's beam"; });
  ASSERT_NE(beam, found.where.end());
  ASSERT_EQ(beam->rows.size(), 2u);
  EXPECT_GT(beam->rows[0].rms, 40e-6);
  // What is left across are 11 um of noise.
  EXPECT_LT(beam->rows[1].rms, 0.3 * beam->rows[0].rms);
}

}  // namespace gap_before_test
}  // namespace stiffscope
