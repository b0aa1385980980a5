#pragma once

#include <optional>

#include "render/grouped_bar_chart.h"
#include "render/point_chart.h"
#include "reports/report_content.h"

namespace stiffscope::app {

/// |displacement| per posture with the double encoders inactive and active, mm. Of an available one.
render::GroupedBarChart encoderBars(const reports::AvoidedByEncoders& avoided);

reports::Figure describeEncoderBars(const reports::AvoidedByEncoders& avoided);

/// The paper's Fig. 7: per posture |displacement| of P_wrist without compensation and after each available
/// method, mm; where P_wrist is not measured, at the reflectors, and the title says so. Each posture is
/// judged by stiffnesses that it took no part in.
render::GroupedBarChart residualBars(const reports::ReportCampaign& one);

/// The paper's Fig. 8: what PP and DPP leave, by themselves. No series where neither is available.
render::GroupedBarChart residualZoom(const reports::ReportCampaign& one);

reports::Figure describeResidualBars(const reports::ReportCampaign& one);
reports::Figure describeResidualZoom(const reports::ReportCampaign& one);

/// What the shown method leaves of each reflector's displacement, b - A c: by posture, reflector and direction
/// along the beam, across it level (to R0's z) and across it upright, in um; where the tracker's noise is
/// declared and points are absolute, in a second row in parts of the standard deviation that this noise gives
/// the displacement. Without them along R0's axes. Empty where no method is available.
std::optional<render::PointChart> residualDirections(const reports::ReportCampaign& one);

reports::Figure describeResidualDirections(const reports::ReportCampaign& one, const render::PointChart& chart);

}  // namespace stiffscope::app
