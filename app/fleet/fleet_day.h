#pragma once

#include <string>

#include "core/fleet/campaign_result.h"

namespace stiffscope::app {

/// What a fleet keeps of a campaign: audited; under loads identified (`springs_only`: without further effects in the
/// model) and diagnosed; without a load calibrated and diagnosed. Throws what reading and computing throw.
fleet::CampaignResult fleetDay(const std::string& folder, bool springs_only);

/// Two days without a load of one machine.
fleet::PairResult fleetPair(const std::string& before, const std::string& after);

}  // namespace stiffscope::app
