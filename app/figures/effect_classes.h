#pragma once

#include <optional>

#include "render/dot_row_chart.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// Which effects these postures and loads can tell apart: a row an effect with the smallest size that would
/// have been seen (um), a column a class of effects that they cannot tell apart, the verdict's effects
/// marked; what cannot be tested says what is missing. Empty where nothing was diagnosed.
std::optional<DotRowChart> effectClasses(const ReportCampaign& one);

Figure describeEffectClasses(const ReportCampaign& one);

}  // namespace stiffscope
