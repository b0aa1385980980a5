#include "core/identification/settled_frames.h"

#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/partial_pose.h"

namespace stiffscope {

StiffnessEstimate sagStiffness(const Campaign& campaign, const IdentifyOptions& options, LoadedArm& arm) {
  const JointMask seen =
      judgeJoints(arm.geometry, arm.cases, *campaign.load_cell, reflectorEquations(arm), options.trust)
          .mask();
  StiffnessEstimate estimate = solveSettled(arm, options.finite_deflection, [&](const LoadedArm& now) {
    return now.wrist.empty() ? partialPose(reflectorEquations(now), seen)
                             : decoupledPartialPose(wristPointEquations(now), reflectorEquations(now), seen);
  });
  estimate.compliance = estimate.compliance.cwiseMax(0.0);  // a negative compliance would lift the arm
  return estimate;
}

Vector6d sagCompliance(const Campaign& campaign, const IdentifyOptions& options, LoadedArm& arm) {
  return sagStiffness(campaign, options, arm).compliance;
}

SettledFrames settleFrames(const Campaign& campaign, const std::vector<int>& steps, const IdentifyOptions& options) {
  SettledFrames settled;
  settled.frames = measureFrames(campaign);
  Vector6d compliance = Vector6d::Zero();
  const auto armNow = [&](std::vector<std::string>* left_out) {
    return loadedArm(campaign, sweptGeometry(campaign, settled.frames, compliance), settled.frames.wrist,
                     steps, left_out);
  };
  for (int round = 0; round < kSagRounds && settled.frames.weight.links_known; ++round) {
    LoadedArm arm = armNow(nullptr);
    if (arm.cases.empty()) break;
    const StiffnessEstimate springs = sagStiffness(campaign, options, arm);
    compliance = springs.compliance;
    const bool last = round + 1 == kSagRounds;  // earlier rounds' uncertainties nobody sees
    settled.frames = refineFrames(campaign, settled.frames, compliance,
                                  last ? std::optional(springs.covariance) : std::nullopt);
  }
  settled.arm = armNow(&settled.left_out);
  return settled;
}

}  // namespace stiffscope
