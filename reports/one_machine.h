#pragma once

#include <string>
#include <vector>

#include "reports/page/report_campaign.h"

namespace stiffscope {

/// What says that the campaigns of a report are not of one machine, a sentence each, every campaign against
/// the first: axes elsewhere (differenceOfMachines), else what doubtsOfOneMachine finds. Empty for a single
/// campaign.
std::vector<std::string> doubtsOfTheMachine(const std::vector<ReportCampaign>& campaigns);

}  // namespace stiffscope
