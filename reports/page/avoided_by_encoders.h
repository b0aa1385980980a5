#pragma once

#include <optional>
#include <vector>

#include "core/identification/avoided.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// What the double encoders avoid of the deflection (paper, IV.E), of the first campaign with them inactive
/// (before) against the first with them active (after). Empty without such a pair; not available, with the
/// reason, where the two have no posture in common.
std::optional<AvoidedDeflection> avoidedByEncoders(const std::vector<ReportCampaign>& campaigns);

/// The point at which it is judged, rich text: "P_{wrist}" or "the reflectors".
std::string pointOf(const AvoidedDeflection& avoided);

}  // namespace stiffscope
