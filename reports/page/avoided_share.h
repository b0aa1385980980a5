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

/// What the double encoders avoid of the deflection: 1 - sum |active| / sum |inactive| over the postures that
/// both campaigns measured under load (paper, IV.E). Under each campaign's own load: the two mean forces are
/// beside it.
struct AvoidedShare {
  double share = 0.0;
  bool at_wrist = false;                            ///< at P_wrist, else at the reflectors (mean over them)
  std::string point;                                ///< the point's name, rich text
  double force_inactive = 0.0, force_active = 0.0;  ///< mean over the common postures, N
  std::vector<AvoidedPosture> postures;
};

/// From the first campaign with double encoders inactive and the first with them active; postures are matched
/// by their names. Empty without such a pair or without a common posture.
std::optional<AvoidedShare> avoidedShare(const std::vector<ReportCampaign>& campaigns);

}  // namespace stiffscope
