#pragma once

#include <string>

#include "core/fleet/fleet.h"

namespace stiffscope::reports {

/// "bearing_tilt|link_compliance+hysteresis": entries of a diagnosis joined by '+'; "none".
std::string effectsKey(const fleet::CampaignResult& result);

/// Of the machine that has most; six without any result.
int mostJointsOf(const fleet::Fleet& fleet);

std::string needName(fleet::NeedId id);  ///< "audit failed"

}  // namespace stiffscope::reports
