#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/page/report_campaign.h"

namespace stiffscope {

/// |displacement| of one posture in both states, m.
struct AvoidedPosture {
  std::string pose;
  double inactive = 0.0, active = 0.0;
};

/// What the double encoders avoid of the deflection (paper, IV.E), as avoidedDeflection finds it: 1 - sum
/// |active| / sum |inactive| over the postures that both states share.
struct AvoidedShare {
  double share = 0.0;
  bool at_wrist = false;  ///< at P_wrist, else at the reflectors (mean over them)
  std::string point;      ///< the point's name, rich text
  std::vector<AvoidedPosture> postures;
};

/// From the first campaign with double encoders inactive and the first with them active. Empty without such a
/// pair, or where these have no posture in common: then `reason` says so.
std::optional<AvoidedShare> avoidedShare(const std::vector<ReportCampaign>& campaigns,
                                         std::string* reason = nullptr);

}  // namespace stiffscope
