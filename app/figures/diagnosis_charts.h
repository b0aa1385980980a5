#pragma once

#include <optional>

#include "render/dot_row_chart.h"
#include "render/grouped_bar_chart.h"
#include "reports/report_content.h"

namespace stiffscope::app {

/// Which effects these postures and loads can tell apart: a row an effect with the smallest size that would
/// have been seen (um), a column a class of effects that they cannot tell apart, the verdict's effects
/// marked; what cannot be tested says what is missing. Empty where nothing was diagnosed.
std::optional<render::DotRowChart> effectClasses(const reports::ReportCampaign& one);

reports::Figure describeEffectClasses(const reports::ReportCampaign& one);

/// The gap of the deflection by posture: what joint stiffnesses alone leave, what is left with the verdict's
/// effects in the model, and what noise alone would leave, rms per coordinate, um. Empty where nothing was
/// diagnosed.
std::optional<render::GroupedBarChart> gapBars(const reports::ReportCampaign& one);

reports::Figure describeGapBars(const reports::ReportCampaign& one);

}  // namespace stiffscope::app
