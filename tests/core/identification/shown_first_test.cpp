#include "core/identification/shown_first.h"

#include <gtest/gtest.h>

#include "core/campaign/read_campaign.h"
#include "core/identification/identify.h"
#include "core/identification/remarks.h"

namespace stiffscope {
namespace shown_first_test {

using identification::Identification;
using identification::Method;
using identification::MethodResult;
using identification::RemarkId;
using Judged = identification::ShownFirst::Judged;

MethodResult& of(Identification& result, Method which) { return result.methods[static_cast<std::size_t>(which)]; }

/// A method with these held-out shares, one a subset.
void judge(MethodResult& method, std::vector<double> at_targets, std::vector<double> at_wrist = {}) {
  method.available = true;
  method.subsets.size = 1;
  method.subsets.of = 2;
  method.subsets.at_targets.held_out = std::move(at_targets);
  method.subsets.at_wrist.held_out = std::move(at_wrist);
}

TEST(MeanOverSubsets, ByHand) {
  const std::vector<double> values{1.0, 2.0, 6.0};
  const identification::MeanOverSubsets found = identification::meanOverSubsets(values);
  EXPECT_DOUBLE_EQ(found.mean, 3.0);
  EXPECT_DOUBLE_EQ(found.sd, std::sqrt(7.0));  // (4 + 1 + 9) / 2
  EXPECT_TRUE(std::isnan(identification::meanOverSubsets({values.data(), 1}).sd));
}

TEST(ShownFirst, TheLargestHeldOutShareAtTheReflectorsWhateverPWristSays) {
  Identification result;
  // The subsets differ by far more than the methods do, which differ by the same in each.
  judge(of(result, Method::partial_pose), {0.61, 0.91, 0.76}, {0.1, 0.2, 0.3});
  judge(of(result, Method::decoupled_partial_pose), {0.60, 0.90, 0.75}, {0.9, 0.9, 0.8});
  const auto found = identification::methodShownFirst(result);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->method, Method::partial_pose);
  EXPECT_EQ(found->judged, Judged::at_reflectors);
  EXPECT_TRUE(found->reason.is(RemarkId::shown_compensates_most));
}

TEST(ShownFirst, WithinTheSpreadOfTheDifferenceTheDecoupledGoesFirst) {
  Identification result;
  // PP is ahead by 2 % on average and behind in one subset of three: differences 5, 4 and -3 %, sd 4.4 %.
  judge(of(result, Method::partial_pose), {0.85, 0.84, 0.77});
  judge(of(result, Method::decoupled_partial_pose), {0.80, 0.80, 0.80});
  auto found = identification::methodShownFirst(result);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->method, Method::decoupled_partial_pose);
  EXPECT_TRUE(found->reason.is(RemarkId::shown_as_good_as_most));
  // Judged on other subsets the spreads of both count: the same means, far ahead in the scatter of neither.
  judge(of(result, Method::partial_pose), {0.85, 0.86, 0.85, 0.86});
  judge(of(result, Method::decoupled_partial_pose), {0.70, 0.80, 0.90});
  found = identification::methodShownFirst(result);
  EXPECT_EQ(found->method, Method::decoupled_partial_pose);
  // Complete Pose is last of equals.
  judge(of(result, Method::decoupled_partial_pose), {0.1, 0.1, 0.1});
  judge(of(result, Method::partial_pose), {0.80, 0.80, 0.80});
  judge(of(result, Method::complete_pose), {0.85, 0.84, 0.77});
  EXPECT_EQ(identification::methodShownFirst(result)->method, Method::partial_pose);
}

TEST(ShownFirst, FarBehindIsNotAsGoodHoweverTheSubsetsScatter) {
  Identification result;
  judge(of(result, Method::partial_pose), {0.55, 0.50, 0.52});
  judge(of(result, Method::decoupled_partial_pose), {0.50, -4.00, 0.02});  // 168 % behind, sd 245 %
  const auto found = identification::methodShownFirst(result);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->method, Method::partial_pose);
  EXPECT_TRUE(found->reason.is(RemarkId::shown_compensates_most));
}

TEST(ShownFirst, WhereTheReflectorsDoNotJudgePWristDoes) {
  Identification result;
  judge(of(result, Method::partial_pose), {}, {0.7, 0.8});
  judge(of(result, Method::decoupled_partial_pose), {0.9, 0.9}, {0.6, 0.7});
  auto found = identification::methodShownFirst(result);
  EXPECT_EQ(found->method, Method::partial_pose);
  EXPECT_EQ(found->judged, Judged::at_wrist);
  // And where neither does, the order of equals; one method alone needs no judging.
  judge(of(result, Method::partial_pose), {}, {});
  found = identification::methodShownFirst(result);
  EXPECT_EQ(found->method, Method::decoupled_partial_pose);
  EXPECT_TRUE(found->reason.is(RemarkId::shown_unjudged));
  of(result, Method::decoupled_partial_pose).available = false;
  found = identification::methodShownFirst(result);
  EXPECT_EQ(found->method, Method::partial_pose);
  EXPECT_TRUE(found->reason.is(RemarkId::shown_alone));
  of(result, Method::partial_pose).available = false;
  EXPECT_FALSE(identification::methodShownFirst(result));
}

TEST(ShownFirst, OfTwoCampaignsTheMeanDecides) {
  Identification before, after;
  judge(of(before, Method::partial_pose), {0.90, 0.90});
  judge(of(before, Method::decoupled_partial_pose), {0.80, 0.80});
  judge(of(after, Method::partial_pose), {0.50, 0.50});
  judge(of(after, Method::decoupled_partial_pose), {0.70, 0.70});
  const std::array<const Identification*, 2> both{&before, &after};
  const auto found = identification::methodShownFirst(both, {false, true, true});
  EXPECT_EQ(found->method, Method::decoupled_partial_pose);  // 75 % against 70 %
  EXPECT_EQ(identification::methodShownFirst(before)->method, Method::partial_pose);
  EXPECT_EQ(identification::methodShownFirst(both, {false, true, false})->method, Method::partial_pose);
}

TEST(ShownFirst, AsAskedAndAsInThePaper) {
  Identification result;
  judge(of(result, Method::partial_pose), {0.9, 0.9});
  judge(of(result, Method::decoupled_partial_pose), {0.8, 0.8});
  EXPECT_EQ(identification::bestMethod(result), Method::decoupled_partial_pose);  // nothing was chosen yet
  result.shown_first = identification::methodShownFirst(result);
  EXPECT_EQ(identification::bestMethod(result), Method::partial_pose);
  const std::vector<Method> asked{Method::decoupled_partial_pose};
  EXPECT_EQ(identification::bestMethodOf(result, asked), Method::decoupled_partial_pose);
  EXPECT_TRUE(identification::shownFirstOf(result, asked)->reason.is(RemarkId::shown_as_asked));
  EXPECT_TRUE(
      identification::shownFirstOf(result, identification::kMethods)->reason.is(RemarkId::shown_compensates_most));
  const auto papers = identification::methodShownFirst(result, true);
  EXPECT_EQ(papers->method, Method::decoupled_partial_pose);
  EXPECT_TRUE(papers->reason.is(RemarkId::shown_as_in_the_paper));
}

TEST(ShownFirst, OfTheSampleBySpringsAlonePartialPose) {
  const campaign::Campaign day =
      campaign::readCampaign(std::string(STIFFSCOPE_SOURCE_DIR) + "/samples/active").campaign;
  identification::IdentifyOptions options;
  options.subsets.most_all = 2000;
  options.subsets.sample = 2000;
  const Identification found = identification::identify(day, options);
  ASSERT_TRUE(found.shown_first);
  EXPECT_EQ(found.shown_first->method, Method::partial_pose);
  // At P_wrist the decoupled method is ahead.
  EXPECT_GT(found.of(Method::decoupled_partial_pose).at_wrist->subsets.held_out,
            found.of(Method::partial_pose).at_wrist->subsets.held_out);
  for (const Method method : identification::kMethods) {
    const MethodResult& one = found.of(method);
    EXPECT_EQ(one.subsets.at_targets.held_out.size(), one.subsets.compliances.size());
    const auto spread = identification::meanOverSubsets(one.subsets.at_targets.held_out);
    EXPECT_NEAR(spread.mean, one.at_targets->subsets.held_out, 1e-12);  // the same sum in another order
    EXPECT_EQ(spread.sd, one.at_targets->held_out_sd);
  }
  options.papers_choice = true;
  EXPECT_EQ(identification::identify(day, options).shown_first->method, Method::decoupled_partial_pose);
}

}  // namespace shown_first_test
}  // namespace stiffscope
