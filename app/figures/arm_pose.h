#pragma once

#include <optional>

#include "core/identification/identify.h"
#include "render/arm_scene.h"
#include "reports/page/report_campaign.h"

namespace stiffscope {

/// The arm of load case `index` as it stands unloaded, with the displacements of reflectors and P_wrist as
/// measured and, where there is a `method` and it is available, as it predicts them and what it leaves:
/// residual = measured - predicted.
ArmPose armPose(const ReportCampaign& one, std::size_t index, std::optional<Method> method);

/// The arm alone. Joint points: from the foot of axis 1 on each axis the point nearest to the one before, then
/// the flange. Axes of R0, origin on axis 1 at the height of base_link's origin, so that the floor is where the
/// robot stands (R0's own origin is at the height of axis 2).
ArmPose bareArm(const Frames& frames, const ArmPosture& posture);

/// Height of R0's origin above the floor of the scene, m.
double heightOfR0(const Frames& frames);

}  // namespace stiffscope
