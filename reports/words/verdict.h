#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/report_content.h"

namespace stiffscope::reports {

/// What says that the campaigns of a report are not of one machine, a sentence each, every campaign against
/// the first: axes elsewhere (differenceOfMachines), else what doubtsOfOneMachine finds. Empty for a single
/// campaign.
std::vector<std::string> doubtsOfTheMachine(const std::vector<ReportCampaign>& campaigns);

/// The result in plain words, one or two sentences a campaign: which joint stiffnesses are known, by which
/// method, what share of the deflection they compensate at which point; then what the double encoders avoid. For days
/// without a load their accuracy, for sweeps alone the axes.
std::string verdictOf(const std::vector<ReportCampaign>& campaigns, const std::optional<AvoidedByEncoders>& avoided);

/// What the diagnosis finds besides joint springs, of the days with a load; empty without a diagnosis.
std::string diagnosisVerdict(const std::vector<ReportCampaign>& campaigns);

}  // namespace stiffscope::reports
