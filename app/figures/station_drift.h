#pragma once

#include <optional>

#include "core/audit/station_motion.h"
#include "render/point_chart.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// How the tracker's station moved over the day by the floor nests: displacement where the arm stands and
/// rotation, with 2 standard uncertainties by the declared noise, and how far each nest was read from its first
/// reading. Axes of the tracker. Empty where the nests cannot tell.
std::optional<PointChart> stationDrift(const ReportCampaign& one, const StationMotion& station);

Figure describeStationDrift(const StationMotion& station);

/// By the declared noise; not tested where none is declared.
StationMotion stationMotionOf(const Campaign& campaign);

}  // namespace stiffscope
