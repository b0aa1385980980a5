#pragma once

#include <vector>

#include "core/compensation/compensate.h"
#include "core/identification/identify.h"
#include "reports/json/campaign_json.h"

namespace stiffscope {

/// The result of `compensate`: a row a posture.
Json compensationJson(const Campaign& campaign, Method method,
                      const std::vector<CompensatedPosture>& postures);

}  // namespace stiffscope
