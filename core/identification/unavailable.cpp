#include "core/identification/unavailable.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/identification/wrist_leak.h"

namespace stiffscope {

std::string whyNoPositions(const Campaign& campaign, const LoadedArm& arm, const JointMask& unknown) {
  if (arm.cases.empty()) {
    if (!campaign.loading && campaign.displacements && !arm.geometry.displacements_in_r0) {
      return "the displacements are in the tracker's frame: circle sweeps of axes 1 and 2 would place it, or "
             "frame=\"base_link\" if they are in the robot's";
    }
    return campaign.loading && !arm.geometry.r0_from_loading
               ? "the loading's readings cannot be brought into R0: circle sweeps of axes 1 and 2 would "
                 "place them"
               : "no posture has readings unloaded and under this load";
  }
  if (std::none_of(unknown.begin(), unknown.end(), [](bool one) { return one; })) {
    return "the load turns no joint enough to see its stiffness";
  }
  return {};
}

std::string whyNoFlangePoses(const Campaign& campaign, const LoadedArm& arm) {
  if (arm.hasFlangePoses()) return {};
  if (arm.cases.front().absolute) {
    return "a flange pose needs three reflectors, placed by circle sweeps, in every posture";
  }
  return fmt::format(
      "a flange pose needs absolute positions of three reflectors; this campaign has displacements of {} "
      "point(s): measure `loading` with three",
      campaign.targets.size());
}

std::string whyNoWristPoint(const Campaign& campaign, const LoadedArm& arm, const WristCentre& wrist) {
  if (!arm.wrist.empty()) return {};
  std::string reason =
      wrist.measured ? "P_wrist needs absolute readings of three reflectors of known radius in every posture: measure "
                       "`loading` and the wrist sweep with three"
                     : "the wrist centre is not measured: " + wrist.reason;
  if (!campaign.wrist_sweep) {
    reason += "; measure a wrist sweep (axes 4-6 moving) and `loading` with three reflectors";
  }
  return reason;
}

std::string whyNotDecoupled(const WristCentre& wrist, double leak) {
  if (leak <= kWristLeakBorne) return {};
  return fmt::format(
      "the wrist's axes do not meet (4 and 5 miss by {:.3f} mm, 5 and 6 by {:.3f} mm): turning in joints 4-6 "
      "moves P_wrist by {:.1f} % of its displacement, more than the {:.0f} % that decoupling bears",
      1e3 * wrist.miss_45, 1e3 * wrist.miss_56, 100.0 * leak, 100.0 * kWristLeakBorne);
}

}  // namespace stiffscope
