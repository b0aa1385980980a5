#include "core/identification/settled_frames.h"

#include "core/identification/method_solution.h"

namespace stiffscope {

namespace {

MethodSolution sagMethod(const Campaign& campaign, const IdentifyOptions& options, const LoadedArm& arm) {
  MethodSolution how;
  how.method = arm.wrist.empty() ? Method::partial_pose : Method::decoupled_partial_pose;
  how.unknown =
      judgeJoints(arm.geometry, arm.cases, *campaign.load_cell, reflectorEquations(arm), options.trust).mask();
  return how;
}

/// A negative compliance would lift the arm.
Vector6d liftsNothing(const Vector6d& compliance) { return compliance.cwiseMax(0.0); }

}  // namespace

StiffnessEstimate sagStiffness(const Campaign& campaign, const IdentifyOptions& options, LoadedArm& arm) {
  const MethodSolution how = sagMethod(campaign, options, arm);
  StiffnessEstimate estimate = how.settledEstimate(arm, options.finite_deflection);
  estimate.compliance = liftsNothing(estimate.compliance);
  return estimate;
}

Vector6d sagCompliance(const Campaign& campaign, const IdentifyOptions& options, LoadedArm& arm) {
  const MethodSolution how = sagMethod(campaign, options, arm);
  return liftsNothing(how.settledCompliance(arm, options.finite_deflection));
}

SettledFrames settleFrames(const Campaign& campaign, const std::vector<int>& steps, const IdentifyOptions& options) {
  SettledFrames settled;
  settled.frames = measureFrames(campaign);
  Vector6d compliance = Vector6d::Zero();
  const LoadReadings readings(campaign, steps);
  const auto armNow = [&](std::vector<std::string>* left_out) {
    return loadedArm(campaign, readings, sweptGeometry(campaign, settled.frames, compliance), settled.frames.wrist, steps,
                     left_out);
  };
  for (int round = 0; round < kSagRounds && settled.frames.weight.links_known; ++round) {
    LoadedArm arm = armNow(nullptr);
    if (arm.cases.empty()) break;
    std::optional<Matrix6d> covariance;  // earlier rounds' uncertainties nobody sees
    if (round + 1 == kSagRounds) {
      const StiffnessEstimate springs = sagStiffness(campaign, options, arm);
      compliance = springs.compliance, covariance = springs.covariance;
    } else {
      compliance = sagCompliance(campaign, options, arm);
    }
    settled.frames = refineFrames(campaign, settled.frames, compliance, covariance);
  }
  settled.arm = armNow(&settled.left_out);
  return settled;
}

SettledDay settleDay(const Campaign& campaign) {
  SettledDay day;
  if (campaign.states && campaign.load_cell) day.step = heaviestStep(campaign);
  if (day.step && (campaign.loading || campaign.displacements)) {
    SettledFrames settled = settleFrames(campaign, {*day.step}, {});
    day.frames = std::move(settled.frames);
    day.arm = std::move(settled.arm);
    return day;
  }
  day.frames = measureFrames(campaign);
  day.arm.geometry = sweptGeometry(campaign, day.frames, Vector6d::Zero());
  return day;
}

}  // namespace stiffscope
