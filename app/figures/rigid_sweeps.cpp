#include "app/figures/rigid_sweeps.h"

#include "reports/page/names.h"

namespace stiffscope {

RigidPoints rigidSweeps(const ReportCampaign& one) {
  const Frames& frames = one.identification.frames;
  const auto shown = page::shownMethod(one.identification);
  if (!frames.sag_removed || !shown) return rigidPoints(one.campaign, {});
  const Vector6d& compliance = one.identification.of(*shown).geometry.compliance;
  return rigidPoints(one.campaign, SagModel(frames.arm.arm, frames.weight, compliance, frames.targets_in_r0_at_zero,
                                            frames.arm.r0_from_points.inverse()));
}

}  // namespace stiffscope
