#include "core/identification/settled_frames.h"

#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/partial_pose.h"

namespace stiffscope {

namespace {

constexpr int kRounds = 3;

/// The stiffnesses that bend the arm under its own weight: by the decoupled method where P_wrist is measured.
Vector6d sagCompliance(const Campaign& campaign, const IdentifyOptions& options, LoadedArm& arm) {
  const JointMask seen =
      judgeJoints(arm.geometry, arm.cases, *campaign.load_cell, reflectorEquations(arm), options.trust)
          .mask();
  const StiffnessEstimate estimate = solveSettled(arm, options.finite_deflection, [&](const LoadedArm& now) {
    return now.wrist.empty() ? partialPose(reflectorEquations(now), seen)
                             : decoupledPartialPose(wristPointEquations(now), reflectorEquations(now), seen);
  });
  return estimate.compliance.cwiseMax(0.0);  // a negative compliance would lift the arm
}

}  // namespace

SettledFrames settleFrames(const Campaign& campaign, int step, const IdentifyOptions& options) {
  SettledFrames settled;
  settled.frames = measureFrames(campaign);
  Vector6d compliance = Vector6d::Zero();
  const auto armNow = [&](std::vector<std::string>* left_out) {
    return loadedArm(campaign, sweptGeometry(campaign, settled.frames, compliance), settled.frames.wrist,
                     step, left_out);
  };
  for (int round = 0; round < kRounds && settled.frames.weight.links_known; ++round) {
    LoadedArm arm = armNow(nullptr);
    if (arm.cases.empty()) break;
    compliance = sagCompliance(campaign, options, arm);
    settled.frames = refineFrames(campaign, settled.frames, compliance);
  }
  settled.arm = armNow(&settled.left_out);
  return settled;
}

}  // namespace stiffscope
