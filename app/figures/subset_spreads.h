#pragma once

#include "render/spread_chart.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// Table II as a picture: the distribution of each identifiable joint's stiffness over the subsets of
/// postures, by method, 10^6 Nm/rad. `with_paper` draws the paper's mean where the campaign declares its
/// double encoders. No panel where no method has subsets.
SpreadChart subsetSpreads(const ReportCampaign& one, bool with_paper);

Figure describeSubsetSpreads(const ReportCampaign& one);

}  // namespace stiffscope
