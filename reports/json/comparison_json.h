#pragma once

#include "core/comparison/compare_campaigns.h"
#include "reports/json/campaign_json.h"

namespace stiffscope {

/// The result of `compare`. `joints` are those of the best method that both campaigns have (`method`); all of
/// them stand under `methods`.
Json comparisonJson(const Campaign& before, const Campaign& after, const Comparison& comparison);

}  // namespace stiffscope
