#pragma once

#include "core/campaign/campaign.h"
#include "core/frames/frames.h"
#include "reports/json/campaign_json.h"

namespace stiffscope::reports {

/// The result of `frames`: R0, axes, link lengths, wrist centre with Table I, P_TCP. Axes, points and the wrist stand in
/// R0 with all joints at zero unless the key says otherwise; what was not measured is null with a reason, or the URDF's,
/// and then `from` beside it says "nominal" (or "partly nominal", between a measured axis and one that was not).
Json framesJson(const campaign::Campaign& campaign, const frames::Frames& frames);

}  // namespace stiffscope::reports
