#pragma once

#include <optional>

#include "render/arm_scene.h"
#include "reports/page/figure.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// The gap between model and machine on the arm: what is left of each reflector's displacement, in the load
/// state of each posture that leaves the most; once by joint stiffnesses alone, once with the verdict's
/// effects in the model, to one scale and seen from one place.
struct GapScenes {
  ArmScene before, after;
};

/// Empty where nothing was diagnosed or nothing found. Of very many arrows only every so many postures' are
/// drawn.
std::optional<GapScenes> gapScenes(const ReportCampaign& one);

Figure describeGapBefore(const ReportCampaign& one, const GapScenes& scenes);
Figure describeGapAfter(const ReportCampaign& one, const GapScenes& scenes);

}  // namespace stiffscope
