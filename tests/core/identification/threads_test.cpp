#include <gtest/gtest.h>

#include <cmath>
#include "core/campaign/read_campaign.h"
#include "core/identification/identify.h"
#include "core/identification/load_dependence.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/on_one_core.h"

namespace stiffscope {
namespace threads_test {

/// The sample's day so many times over, reading by reading moved a little: enough postures to share.
campaign::Campaign manyTimes(const campaign::Campaign& day, int times) {
  campaign::Campaign many = day;
  const auto postures = static_cast<int>(day.pose_ids.size());
  const auto again = [&](auto& table, const auto& of_day, int k) {
    for (auto row : of_day) {
      row.pose += k * postures;
      table.push_back(row);
    }
  };
  for (int k = 1; k < times; ++k) {
    for (const std::string& pose : day.pose_ids) many.pose_ids.push_back(pose + "-" + std::to_string(k));
    again(many.states->rows, day.states->rows, k);
    again(many.loading->rows, day.loading->rows, k);
  }
  double n = 0.0;
  for (campaign::LoadingReading& row : many.loading->rows) row.point.x() += 1e-5 * std::sin(n++);
  return many;
}

void expectSame(const identification::StiffnessEstimate& a, const identification::StiffnessEstimate& b) {
  EXPECT_EQ(a.compliance, b.compliance);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.influences, b.influences);
  EXPECT_EQ(a.scatter_dof, b.scatter_dof);
  EXPECT_EQ(a.rms_residual, b.rms_residual);
}

TEST(Identify, DoesNotDependOnTheNumberOfCores) {
  const campaign::Campaign day =
      campaign::readCampaign(std::string(STIFFSCOPE_SOURCE_DIR) + "/samples/active").campaign;
  const campaign::Campaign campaign = manyTimes(day, 60);  // 1140 postures: more than kWorthThreads
  const identification::Identification all = identification::identify(campaign);
  const identification::StepStudy all_steps = identification::studySteps(campaign, {}, all);
  const OnOneCore alone;
  const identification::Identification one = identification::identify(campaign);
  const identification::StepStudy one_steps = identification::studySteps(campaign, {}, one);
  for (std::size_t m = 0; m < all.methods.size(); ++m) {
    const identification::MethodResult &a = all.methods[m], &b = one.methods[m];
    ASSERT_TRUE(a.available) << reports::words(a.reason);
    expectSame(a.estimate, b.estimate);
    EXPECT_EQ(a.subsets.compliances, b.subsets.compliances);
    EXPECT_EQ(a.subsets.at_targets.left_held_out, b.subsets.at_targets.left_held_out);
    EXPECT_EQ(a.at_targets->subsets.held_out, b.at_targets->subsets.held_out);
    ASSERT_EQ(all_steps.methods[m].steps.size(), one_steps.methods[m].steps.size());
    for (std::size_t s = 0; s < all_steps.methods[m].steps.size(); ++s) {
      expectSame(all_steps.methods[m].steps[s].estimate, one_steps.methods[m].steps[s].estimate);
    }
  }
  EXPECT_EQ(all.cautions, one.cautions);
  EXPECT_EQ(all.geometric_stiffness_share, one.geometric_stiffness_share);
}

}  // namespace threads_test
}  // namespace stiffscope
