#include "core/comparison/compare_campaigns.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/identification/best_method.h"

namespace stiffscope {

Method Comparison::best() const { return bestMethod(*this); }

namespace {

std::vector<std::string> cautionsOf(const Campaign& before_campaign, const Campaign& after_campaign,
                                    const Comparison& result) {
  std::vector<std::string> cautions = doubtsOfOneMachine(before_campaign.robot, after_campaign.robot);
  if (before_campaign.double_encoder == after_campaign.double_encoder &&
      before_campaign.double_encoder != DoubleEncoder::unspecified) {
    cautions.push_back(
        fmt::format("both campaigns were measured with double encoders {}",
                    before_campaign.double_encoder == DoubleEncoder::active ? "active" : "inactive"));
  }
  if (before_campaign.double_encoder == DoubleEncoder::active &&
      after_campaign.double_encoder == DoubleEncoder::inactive) {
    cautions.push_back(
        "the first campaign has the double encoders active and the second inactive: the other way "
        "round, `avoided` is what the encoders avoid");
  }
  const std::size_t all = result.matched.pairs.size() + result.matched.unmatched.size();
  if (!result.matched.pairs.empty() && 2 * result.matched.pairs.size() < all) {
    cautions.push_back(fmt::format("only {} of {} postures correspond", result.matched.pairs.size(), all));
  }
  return cautions;
}

/// What identification itself cautions of, which ratios and p-values inherit.
void addCautions(const char* when, const Identification& one, std::vector<std::string>& cautions) {
  for (const std::string& caution : one.cautions) cautions.push_back(fmt::format("{}: {}", when, caution));
}

}  // namespace

Comparison compareCampaigns(const Campaign& before_campaign, const Identification& before,
                            const Campaign& after_campaign, const Identification& after,
                            const BootstrapOptions& options) {
  Comparison result;
  result.reason = differenceOfMachines(before_campaign.robot, after_campaign.robot);
  if (!result.reason.empty()) {
    for (StiffnessChange& method : result.methods) method.reason = result.reason;
    result.at_wrist.reason = result.at_targets.reason = result.reason;
    return result;
  }
  result.matched = matchPostures(before_campaign, before, after_campaign, after);
  for (const Method method : kMethods) {
    result.methods[static_cast<std::size_t>(method)] =
        compareStiffness(before, after, method, result.matched);
  }
  result.at_wrist = deflectionAvoidedAtWrist(before, after, result.matched, options);
  result.at_targets = deflectionAvoidedAtTargets(before, after, result.matched, options);
  result.comparable =
      result.avoided().available || std::any_of(result.methods.begin(), result.methods.end(),
                                                [](const StiffnessChange& one) { return one.available; });
  if (!result.comparable) {
    result.reason = result.at_targets.reason + "; " + result.of(result.best()).reason;
  }
  result.cautions = cautionsOf(before_campaign, after_campaign, result);
  addCautions("before", before, result.cautions);
  addCautions("after", after, result.cautions);
  return result;
}

}  // namespace stiffscope
