#include "reports/page/avoided_by_encoders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/comparison/matched_postures.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

const ReportCampaign* firstWith(const std::vector<ReportCampaign>& campaigns, DoubleEncoder state) {
  const auto found = std::find_if(campaigns.begin(), campaigns.end(), [state](const ReportCampaign& one) {
    return one.campaign.double_encoder == state;
  });
  return found == campaigns.end() ? nullptr : &*found;
}

}  // namespace

std::optional<AvoidedByEncoders> avoidedByEncoders(const std::vector<ReportCampaign>& campaigns) {
  const ReportCampaign* inactive = firstWith(campaigns, DoubleEncoder::inactive);
  const ReportCampaign* active = firstWith(campaigns, DoubleEncoder::active);
  if (inactive == nullptr || active == nullptr) return std::nullopt;
  AvoidedByEncoders avoided;
  avoided.reason = differenceOfMachines(inactive->campaign.robot, active->campaign.robot);
  if (!avoided.reason.empty()) return avoided;
  const Identification &before = inactive->identification, &after = active->identification;
  const MatchedPostures matched = matchPostures(inactive->campaign, before, active->campaign, after);
  static_cast<DeflectionAvoided&>(avoided) = deflectionAvoidedAtWrist(before, after, matched);
  avoided.at_wrist = avoided.available;
  if (!avoided.available)
    static_cast<DeflectionAvoided&>(avoided) = deflectionAvoidedAtTargets(before, after, matched);
  return avoided;
}

std::string pointOf(const AvoidedByEncoders& avoided) {
  return avoided.at_wrist ? "P_{wrist}" : "the reflectors";
}

std::string shareWords(const AvoidedByEncoders& avoided) {
  const std::string share = page::percent(avoided.share);
  if (!std::isfinite(avoided.low)) return share;
  return fmt::format("{} (95\u00a0%: {} to {})", share, page::fixed(100.0 * avoided.low, 1),
                     page::percent(avoided.high));
}

}  // namespace stiffscope
