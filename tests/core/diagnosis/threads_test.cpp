#include <gtest/gtest.h>
#include "core/campaign/read_campaign.h"
#include "core/diagnosis/diagnose.h"
#include "core/preparation/subsample.h"
#include "tests/fixtures/on_one_core.h"

namespace stiffscope {
namespace threads_test {

void expectSame(const diagnosis::Shrink& a, const diagnosis::Shrink& b) {
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
}

TEST(Diagnose, DoesNotDependOnTheNumberOfCores) {
  // The postures held out are shared among as many threads as there are cores; every digit stays.
  const campaign::Campaign campaign = preparation::evenlySpread(
      campaign::readCampaign(std::string(STIFFSCOPE_SOURCE_DIR) + "/samples/active").campaign, 8);
  diagnosis::DiagnoseOptions quick;
  quick.resamples = 6;
  quick.chance_draws = 20;
  const diagnosis::Diagnosis all = diagnosis::diagnose(campaign, quick);
  const OnOneCore alone;
  const diagnosis::Diagnosis one = diagnosis::diagnose(campaign, quick);
  EXPECT_EQ(all.gap.before, one.gap.before);
  EXPECT_EQ(all.gap.after, one.gap.after);
  expectSame(all.shrink_together, one.shrink_together);
  ASSERT_EQ(all.classes.size(), one.classes.size());
  ASSERT_FALSE(all.classes.empty());
  for (std::size_t i = 0; i < all.classes.size(); ++i) {
    EXPECT_EQ(all.classes[i].effects, one.classes[i].effects);
    expectSame(all.classes[i].shrink, one.classes[i].shrink);
    expectSame(all.classes[i].shrink_of_positions, one.classes[i].shrink_of_positions);
  }
}

}  // namespace threads_test
}  // namespace stiffscope
