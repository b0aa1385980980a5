#pragma once

#include <optional>

#include "core/preparation/drift_nests.h"
#include "render/point_chart.h"
#include "reports/report_content.h"

namespace stiffscope::app {

/// How the tracker's station moved over the day by the floor nests: displacement where the arm stands and
/// rotation, with 2 standard uncertainties by the declared noise, and how far each nest was read from its first
/// reading. Axes of the tracker. Empty where the nests cannot tell.
std::optional<render::PointChart> stationDrift(const reports::ReportCampaign& one, const preparation::StationMotion& station);

reports::Figure describeStationDrift(const preparation::StationMotion& station);

/// By the declared noise; not tested where none is declared.
preparation::StationMotion stationMotionOf(const campaign::Campaign& campaign);

}  // namespace stiffscope::app
