#pragma once

#include "core/identification/identify.h"
#include "reports/json/campaign_json.h"

namespace stiffscope {

/// The result of `identify`. `methods` may leave some out: those asked for.
Json identificationJson(const Campaign& campaign, const Identification& result, const std::vector<Method>& methods);

}  // namespace stiffscope
