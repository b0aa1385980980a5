#include "core/frames/arm_geometry.h"

namespace stiffscope::frames {

LoadingGeometry sweptGeometry(const campaign::Campaign& campaign, const Frames& frames, const JointVector& compliance) {
  LoadingGeometry geometry;
  geometry.arm = frames.arm.arm;
  geometry.targets_at_zero = frames.targets_in_r0_at_zero;
  geometry.r0_from_base_link = frames.arm.r0_from_base_link;
  geometry.weight = frames.weight;
  geometry.compliance = compliance;
  if (!frames.weight.links_known) geometry.compliance.setZero(geometry.arm.joints());
  if (campaign.loading) geometry.r0_from_loading = r0FromTable(frames, campaign.loading->frame);
  if (campaign.displacements) {
    if (const auto r0_from_table = r0FromTable(frames, campaign.displacements->frame)) {
      geometry.displacements_in_r0 = r0_from_table->linear();
    }
  }
  return geometry;
}

}  // namespace stiffscope::frames
