#pragma once

#include "render/grouped_bar_chart.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// The paper's Fig. 7: per posture |displacement| of P_wrist without compensation and after each available
/// method, mm; where P_wrist is not measured, at the reflectors, and the title says so. Each posture is
/// judged by stiffnesses that it took no part in.
GroupedBarChart residualBars(const ReportCampaign& one);

/// The paper's Fig. 8: what PP and DPP leave, by themselves. No series where neither is available.
GroupedBarChart residualZoom(const ReportCampaign& one);

Figure describeResidualBars(const ReportCampaign& one);
Figure describeResidualZoom(const ReportCampaign& one);

}  // namespace stiffscope
