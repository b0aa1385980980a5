#pragma once

#include "core/planning/plan.h"
#include "reports/json/campaign_json.h"

namespace stiffscope::reports {

/// The result of `plan`: a row a posture, and what random postures would give.
Json planJson(const campaign::Campaign& campaign, const planning::Plan& plan);

}  // namespace stiffscope::reports
