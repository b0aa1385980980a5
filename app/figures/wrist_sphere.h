#pragma once

#include <optional>

#include "core/frames/rigid_points.h"
#include "render/point_chart.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// Radial residuals of the wrist's spheres, |x - P_wrist| - r, um, against where on the sphere the reflector
/// stood: azimuth about R0's z, and elevation above its level plane. A line through the means of sectors.
/// Empty where the wrist centre is not measured.
std::optional<PointChart> wristSphere(const ReportCampaign& one, const RigidPoints& points);

Figure describeWristSphere(const ReportCampaign& one);

}  // namespace stiffscope
