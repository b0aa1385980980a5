#include "core/accuracy/diagnose_accuracy.h"

#include <gtest/gtest.h>

#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace diagnose_accuracy_test {

TEST(DiagnoseAccuracy, ACleanDayIsNone) {
  Noise noise(11);
  const UnloadedSpec spec = builtOtherwise(noise);
  const accuracy::AccuracyDiagnosis result =
      accuracy::diagnoseAccuracy(preparation::prepareCampaign(unloadedCampaign(spec, noise)));
  ASSERT_TRUE(result.usable);
  EXPECT_TRUE(result.verdict.empty());
  EXPECT_GT(result.gap.nominal, 5.0 * result.gap.before);
}

}  // namespace diagnose_accuracy_test
}  // namespace stiffscope
