#pragma once

#include "render/interval_chart.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// Joint stiffnesses from all postures by method, value +- expanded uncertainty (page::coverageOf), Nm/rad,
/// logarithmic axis. A joint that is not identifiable leaves a gap; negative and imprecise values are hollow. No series
/// where no method is available.
IntervalChart stiffnessIntervals(const ReportCampaign& one);

Figure describeStiffnessIntervals(const ReportCampaign& one);

}  // namespace stiffscope
