#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/page/avoided_by_encoders.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// The result in plain words, one or two sentences a campaign: which joint stiffnesses are known, by which
/// method, what share of the deflection they compensate at which point; then what the double encoders avoid, and what the
/// diagnosis finds besides joint springs.
std::string verdictOf(const std::vector<ReportCampaign>& campaigns,
                      const std::optional<AvoidedByEncoders>& avoided);

}  // namespace stiffscope
