#include <gtest/gtest.h>

#include <cmath>

#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/gap_study.h"
#include "core/preparation/prepare.h"
#include "core/simulation/measure.h"
#include "tests/fixtures/extended_day.h"

// What a fit leaves of the loading, over the degrees of freedom that it has.

namespace stiffscope {
namespace residual_of_loading_test {

diagnosis::GapStudy studyOf(std::uint64_t seed, bool sweeps = true) {
  campaign::Campaign campaign = simulation::simulate(springsAlone(seed));
  if (!sweeps) campaign.wrist_sweep.reset();
  return diagnosis::studyGap(preparation::prepareCampaign(campaign));
}

// Days on which the model is right leave 1 on average, and each no more than chance makes of it. With the parameters
// counted as equations, or with what chance does to the sweeps in it, they do not.
TEST(LoadingResidual, OfNoiseIsOneADegreeOfFreedom) {
  double sum = 0.0;
  constexpr int kDays = 8;
  for (int day = 0; day < kDays; ++day) {
    const diagnosis::GapFit fit = studyOf(static_cast<std::uint64_t>(41 + day)).fit;
    const double left = diagnosis::leftPerEquation(fit);
    EXPECT_LT(std::abs(left - 1.0), fit.left_limit - 1.0) << day;
    sum += left;
  }
  EXPECT_NEAR(sum / kDays, 1.0, 0.04);
}

// The loading pays for what it determines itself: for stiffnesses all, for the geometry the less the more is swept.
TEST(LoadingResidual, TheSweepsPayForTheGeometry) {
  const diagnosis::GapStudy with = studyOf(41), fewer = studyOf(41, false);
  const auto taken = [](const diagnosis::GapFit& fit) {
    return static_cast<double>(fit.data->loading_rows) - fit.left_before.freedom;
  };
  EXPECT_GT(taken(with.fit), 6.0);
  EXPECT_LT(taken(with.fit), taken(fewer.fit));
  EXPECT_LT(taken(fewer.fit), static_cast<double>(fewer.fit.data->layout.effects));
}

TEST(LoadingResidual, IsWhatADiagnosisPrints) {
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(springsAlone(41)));
  const diagnosis::GapStudy study = diagnosis::studyGap(prepared);
  diagnosis::DiagnoseOptions quick;
  quick.resamples = quick.chance_draws = 0;
  const diagnosis::Diagnosis found = diagnosis::diagnose(prepared, study, quick);
  EXPECT_EQ(found.left_over, study.fit.left.chi2 / study.fit.left.freedom);
  EXPECT_EQ(found.left_over_limit, study.fit.left_limit);
}

}  // namespace residual_of_loading_test
}  // namespace stiffscope
