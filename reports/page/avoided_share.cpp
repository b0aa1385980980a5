#include "reports/page/avoided_share.h"

#include <algorithm>

#include "reports/page/names.h"

namespace stiffscope {

namespace {

const ReportCampaign* firstWith(const std::vector<ReportCampaign>& campaigns, DoubleEncoder state) {
  const auto found = std::find_if(campaigns.begin(), campaigns.end(), [state](const ReportCampaign& one) {
    return one.campaign.double_encoder == state;
  });
  return found == campaigns.end() ? nullptr : &*found;
}

const std::string& poseName(const ReportCampaign& one, const LoadCase& load_case) {
  return one.campaign.pose_ids[static_cast<std::size_t>(load_case.pose)];
}

}  // namespace

std::optional<AvoidedShare> avoidedShare(const std::vector<ReportCampaign>& campaigns) {
  const ReportCampaign* inactive = firstWith(campaigns, DoubleEncoder::inactive);
  const ReportCampaign* active = firstWith(campaigns, DoubleEncoder::active);
  if (inactive == nullptr || active == nullptr) return std::nullopt;
  AvoidedShare result;
  result.at_wrist = page::judgedPoint(*inactive).at_wrist && page::judgedPoint(*active).at_wrist;
  result.point = result.at_wrist ? "P_{wrist}" : "the reflectors";
  const auto& before = page::displacementAt(inactive->identification, result.at_wrist);
  const auto& after = page::displacementAt(active->identification, result.at_wrist);
  const auto& others = active->identification.cases;
  double sum_inactive = 0.0, sum_active = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const LoadCase& one = inactive->identification.cases[i];
    const std::string& name = poseName(*inactive, one);
    const auto same = std::find_if(others.begin(), others.end(),
                                   [&](const LoadCase& other) { return poseName(*active, other) == name; });
    if (same == others.end()) continue;
    const double left = after[static_cast<std::size_t>(same - others.begin())];
    result.postures.push_back({name, before[i], left});
    sum_inactive += before[i];
    sum_active += left;
    result.force_inactive += one.wrench.force.norm();
    result.force_active += same->wrench.force.norm();
  }
  if (sum_inactive <= 0.0) return std::nullopt;
  result.share = 1.0 - sum_active / sum_inactive;
  const auto count = static_cast<double>(result.postures.size());
  result.force_inactive /= count;
  result.force_active /= count;
  return result;
}

}  // namespace stiffscope
