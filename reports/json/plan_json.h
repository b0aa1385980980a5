#pragma once

#include "core/planning/plan.h"
#include "reports/json/campaign_json.h"

namespace stiffscope {

/// The result of `plan`: a row a posture, and what random postures would give.
Json planJson(const Campaign& campaign, const Plan& plan);

}  // namespace stiffscope
