#pragma once

#include "render/interval_chart.h"
#include "render/spread_chart.h"
#include "reports/report_content.h"

namespace stiffscope::app {

/// Joint stiffnesses from all postures by method, value +- expanded uncertainty (page::coverageOf), Nm/rad,
/// logarithmic axis. A joint that is not identifiable leaves a gap; negative and imprecise values are hollow. No series
/// where no method is available.
render::IntervalChart stiffnessIntervals(const reports::ReportCampaign& one);

reports::Figure describeStiffnessIntervals(const reports::ReportCampaign& one);

/// Table II as a picture: the distribution of each identifiable joint's stiffness over the subsets of
/// postures, by method, 10^6 Nm/rad. `with_paper` draws the paper's mean where the campaign declares its
/// double encoders. No panel where no method has subsets.
render::SpreadChart subsetSpreads(const reports::ReportCampaign& one, bool with_paper);

reports::Figure describeSubsetSpreads(const reports::ReportCampaign& one);

}  // namespace stiffscope::app
