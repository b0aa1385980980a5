#pragma once

#include "core/comparison/compare.h"
#include "reports/json/campaign_json.h"

namespace stiffscope::reports {

/// The result of `compare`. `joints` are those of the best method that both campaigns have (`method`); all of
/// them stand under `methods`.
Json comparisonJson(const campaign::Campaign& before, const campaign::Campaign& after, const comparison::Comparison& comparison);

}  // namespace stiffscope::reports
