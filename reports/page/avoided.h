#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/identification/avoided.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// What the double encoders avoid (paper, IV.E), from the first campaign with them inactive and the first
/// with them active; unavailable, with the reason, where these have no posture in common. Empty where a state
/// is missing.
std::optional<AvoidedDeflection> avoidedByDoubleEncoders(const std::vector<ReportCampaign>& campaigns);

namespace page {

/// "P_{wrist}" or "the reflectors".
std::string avoidedPoint(const AvoidedDeflection& avoided);

}  // namespace page

}  // namespace stiffscope
