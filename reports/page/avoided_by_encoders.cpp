#include "reports/page/avoided_by_encoders.h"

#include <algorithm>

namespace stiffscope {

namespace {

const ReportCampaign* firstWith(const std::vector<ReportCampaign>& campaigns, DoubleEncoder state) {
  const auto found = std::find_if(campaigns.begin(), campaigns.end(), [state](const ReportCampaign& one) {
    return one.campaign.double_encoder == state;
  });
  return found == campaigns.end() ? nullptr : &*found;
}

}  // namespace

std::optional<AvoidedDeflection> avoidedByEncoders(const std::vector<ReportCampaign>& campaigns) {
  const ReportCampaign* inactive = firstWith(campaigns, DoubleEncoder::inactive);
  const ReportCampaign* active = firstWith(campaigns, DoubleEncoder::active);
  if (inactive == nullptr || active == nullptr) return std::nullopt;
  return avoidedDeflection(inactive->campaign, inactive->identification, active->campaign,
                           active->identification);
}

std::string pointOf(const AvoidedDeflection& avoided) {
  return avoided.at_wrist ? "P_{wrist}" : "the reflectors";
}

}  // namespace stiffscope
