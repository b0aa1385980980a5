#pragma once

#include <optional>

#include "render/point_chart.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// What the shown method leaves of each reflector's displacement, b - A c: by posture, reflector and direction
/// along the beam, across it level (to R0's z) and across it upright, in um; where the tracker's noise is
/// declared and points are absolute, in a second row in parts of the standard deviation that this noise gives
/// the displacement. Without them along R0's axes. Empty where no method is available.
std::optional<PointChart> residualDirections(const ReportCampaign& one);

Figure describeResidualDirections(const ReportCampaign& one, const PointChart& chart);

}  // namespace stiffscope
