#pragma once

#include <string>

#include "core/fleet/fleet.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// What a fleet keeps of one campaign, in SI units and radians, and back without loss of a digit. What is not a number
/// is null; of an interval whose low end is a number a null high end is open. Throws std::runtime_error where `json`
/// was not written by the first.
Json keptJson(const fleet::CampaignResult& result);
fleet::CampaignResult keptCampaign(const Json& json);

/// The same of two days without a load, of a machine of so many joints.
Json keptJson(const fleet::PairResult& result);
fleet::PairResult keptPair(const Json& json, int joints);

/// fleet.jsonl: one object a campaign, in the fleet's order, a line each.
std::string fleetJsonLines(const fleet::Fleet& fleet);

const char* keyOf(fleet::DayKind kind);  ///< "loaded", "unloaded", "sweeps"
const char* keyOf(fleet::NeedId id);     ///< "audit_failed"

}  // namespace stiffscope::reports
