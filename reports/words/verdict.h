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

/// The same, an item a day and finding: for a list.
std::vector<std::string> verdictItems(const std::vector<ReportCampaign>& campaigns,
                                      const std::optional<AvoidedByEncoders>& avoided);

/// Joints that are stated to have no double encoder and that differ between its two states all the same: then the
/// encoders are not all that changed from the one day to the other. "k_{4} by +11 %, k_{5} by +53 %"; empty where there
/// is none, or where nobody states which joints have one.
std::string changedWithoutEncoder(const std::vector<ReportCampaign>& campaigns, const AvoidedByEncoders& avoided);

/// Where every stiffness that is shown first is negative: that no share of the deflection counts as compensated, a
/// clause. Empty else. What such springs take away is a fit of readings with a wrench that contradicts them.
std::string negativeFitWords(const identification::Identification& identification);

/// What the diagnosis finds besides joint springs, of the days with a load; empty without a diagnosis.
std::string diagnosisVerdict(const std::vector<ReportCampaign>& campaigns);

}  // namespace stiffscope::reports
