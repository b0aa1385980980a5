#pragma once

#include <optional>
#include <vector>

#include "core/comparison/deflection_avoided.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// What active double encoders keep away of the deflection (paper, IV.E), with its interval over postures.
struct AvoidedByEncoders : DeflectionAvoided {
  bool at_wrist = false;  ///< judged at P_wrist; else at the reflectors (means)
};

/// Of the first campaign with the double encoders inactive (before) against the first with them active
/// (after). Empty without such a pair; not available, with the reason, where they are of two machines or have
/// no posture in common.
std::optional<AvoidedByEncoders> avoidedByEncoders(const std::vector<ReportCampaign>& campaigns);

/// The point at which it is judged, rich text: "P_{wrist}" or "the reflectors".
std::string pointOf(const AvoidedByEncoders& avoided);

/// "33.2 % (95 %: 31.0 to 35.1 %)"; without an interval the share alone.
std::string shareWords(const AvoidedByEncoders& avoided);

}  // namespace stiffscope
