#pragma once

#include <optional>

#include "core/frames/rigid_points.h"
#include "render/point_chart.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// The circles of every measured axis with their radial residuals, rho - r, magnified: a ring a reflector,
/// rings of equal distance (their radii are not to scale), the angle that of the joint. Empty where no axis
/// was swept.
std::optional<PointChart> sweepCircles(const ReportCampaign& one, const RigidPoints& points);

Figure describeSweepCircles(const ReportCampaign& one);

}  // namespace stiffscope
