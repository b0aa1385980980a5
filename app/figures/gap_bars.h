#pragma once

#include <optional>

#include "render/grouped_bar_chart.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// The gap of the deflection by posture: what joint stiffnesses alone leave, what is left with the verdict's
/// effects in the model, and what noise alone would leave, rms per coordinate, um. Empty where nothing was
/// diagnosed.
std::optional<GroupedBarChart> gapBars(const ReportCampaign& one);

Figure describeGapBars(const ReportCampaign& one);

}  // namespace stiffscope
