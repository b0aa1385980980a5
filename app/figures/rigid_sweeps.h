#pragma once

#include "core/frames/rigid_points.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// The sweeps' readings as the frames of the identification were fitted to: the own weight's sag taken off
/// where it was taken off there.
RigidPoints rigidSweeps(const ReportCampaign& one);

}  // namespace stiffscope
