#pragma once

#include <string>

#include "core/fleet/fleet.h"

namespace stiffscope::reports {

/// "bearing_tilt|link_compliance+hysteresis": entries of a diagnosis joined by '+'; "none".
std::string effectsKey(const fleet::CampaignResult& result);

/// Of the machine that has most; six without any result.
int mostJointsOf(const fleet::Fleet& fleet);

/// "F-17"; "lab (machine 2 of 3)" where campaigns of several machines bear one name.
std::string machineWords(const fleet::Fleet& fleet, const fleet::DaySeries& series);

/// 1, 2..: which machine of its name a series is of.
int machineNumber(const fleet::Fleet& fleet, const fleet::DaySeries& series);

std::string needName(fleet::NeedId id);  ///< "audit failed"

}  // namespace stiffscope::reports
