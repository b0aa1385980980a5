#include "reports/page/avoided_share.h"

#include <algorithm>

#include "core/identification/avoided.h"

namespace stiffscope {

namespace {

const ReportCampaign* firstWith(const std::vector<ReportCampaign>& campaigns, DoubleEncoder state) {
  const auto found = std::find_if(campaigns.begin(), campaigns.end(), [state](const ReportCampaign& one) {
    return one.campaign.double_encoder == state;
  });
  return found == campaigns.end() ? nullptr : &*found;
}

}  // namespace

std::optional<AvoidedShare> avoidedShare(const std::vector<ReportCampaign>& campaigns, std::string* reason) {
  const ReportCampaign* inactive = firstWith(campaigns, DoubleEncoder::inactive);
  const ReportCampaign* active = firstWith(campaigns, DoubleEncoder::active);
  if (inactive == nullptr || active == nullptr) return std::nullopt;
  const AvoidedDeflection found = avoidedDeflection(inactive->campaign, inactive->identification,
                                                    active->campaign, active->identification);
  if (!found.available) {
    if (reason != nullptr) *reason = found.reason;
    return std::nullopt;
  }
  AvoidedShare result{found.share, found.at_wrist, found.at_wrist ? "P_{wrist}" : "the reflectors", {}};
  for (const AvoidedAtPosture& one : found.postures)
    result.postures.push_back({one.pose, one.before, one.after});
  return result;
}

}  // namespace stiffscope
