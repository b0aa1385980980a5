#pragma once

#include <vector>

#include "core/compensation/compensate.h"
#include "core/identification/identify.h"
#include "reports/json/campaign_json.h"

namespace stiffscope::reports {

/// The result of `compensate`: a row a posture.
Json compensationJson(const campaign::Campaign& campaign, identification::Method method,
                      const std::vector<compensation::CompensatedPosture>& postures);

}  // namespace stiffscope::reports
