#include "core/identification/method_solution.h"

#include <utility>

#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/estimate.h"
#include "core/identification/loaded_arm.h"
#include "core/identification/noise_share.h"
#include "core/identification/partial_pose.h"
#include "core/preparation/subsample.h"

namespace stiffscope::identification {

namespace {

MethodSolution sagMethod(const campaign::Campaign& campaign, const IdentifyOptions& options, const LoadedArm& arm) {
  MethodSolution how;
  how.method = arm.wrist.empty() ? Method::partial_pose : Method::decoupled_partial_pose;
  how.unknown =
      evaluateIdentifiability(arm.geometry, arm.cases, *campaign.load_cell, reflectorEquations(arm), options.trust)
          .mask();
  return how;
}

/// A negative compliance would lift the arm.
JointVector liftsNothing(const JointVector& compliance) { return compliance.cwiseMax(0.0); }

}  // namespace

StiffnessEstimate sagStiffness(const campaign::Campaign& campaign, const IdentifyOptions& options, LoadedArm& arm) {
  const MethodSolution how = sagMethod(campaign, options, arm);
  StiffnessEstimate estimate = how.solvedEstimate(arm, options.finite_deflection);
  estimate.compliance = liftsNothing(estimate.compliance);
  return estimate;
}

JointVector sagCompliance(const campaign::Campaign& campaign, const IdentifyOptions& options, LoadedArm& arm) {
  const MethodSolution how = sagMethod(campaign, options, arm);
  return liftsNothing(how.solvedCompliance(arm, options.finite_deflection));
}

SolvedFrames solveFrames(const campaign::Campaign& campaign, const std::vector<int>& steps,
                         const IdentifyOptions& options) {
  SolvedFrames settled;
  settled.frames = frames::measureFrames(campaign);
  JointVector compliance = JointVector::Zero(campaign.robot.joints());
  const LoadReadings readings(campaign, steps);
  const auto armNow = [&](const campaign::Campaign& loads, const LoadReadings& of_loads,
                          std::vector<LeftOutPosture>* left_out) {
    return loadedArm(loads, of_loads, frames::sweptGeometry(campaign, settled.frames, compliance), settled.frames.wrist,
                     steps, left_out);
  };
  std::optional<campaign::Campaign> some;  // a long day's, for rounds that only bring the last one near
  std::optional<LoadReadings> of_some;
  if (campaign.pose_ids.size() > preparation::kMostAveraged) {
    some = preparation::evenlySpread(campaign, preparation::kMostAveraged, preparation::kMostSwept, steps);
    of_some.emplace(*some, steps);
  }
  for (int round = 0; round < kSagRounds && settled.frames.weight.links_known; ++round) {
    const bool last = round + 1 == kSagRounds;
    LoadedArm arm = some && !last ? armNow(*some, *of_some, nullptr) : armNow(campaign, readings, nullptr);
    if (arm.cases.empty()) break;
    std::optional<JointMatrix> covariance;  // earlier rounds' uncertainties nobody sees
    if (last) {
      const StiffnessEstimate springs = sagStiffness(campaign, options, arm);
      compliance = springs.compliance, covariance = springs.covariance;
    } else {
      compliance = sagCompliance(campaign, options, arm);
    }
    settled.frames = frames::refineFrames(campaign, settled.frames, compliance, covariance);
  }
  settled.arm = armNow(campaign, readings, &settled.left_out);
  return settled;
}

SolvedDay solveDay(const campaign::Campaign& campaign) {
  SolvedDay day;
  if (campaign.states && campaign.load_cell) day.step = heaviestStep(campaign);
  if (day.step && (campaign.loading || campaign.displacements)) {
    SolvedFrames settled = solveFrames(campaign, {*day.step}, {});
    day.frames = std::move(settled.frames);
    day.arm = std::move(settled.arm);
    return day;
  }
  day.frames = frames::measureFrames(campaign);
  day.arm.geometry = frames::sweptGeometry(campaign, day.frames, JointVector::Zero(campaign.robot.joints()));
  return day;
}

StiffnessEstimate MethodSolution::estimate(const LoadedArm& arm, const PointEquations& equations) const {
  switch (method) {
    case Method::complete_pose:
      return completePose(poseEquations(arm, tcp_in_flange), length, unknown);
    case Method::decoupled_partial_pose:
      return decoupledPartialPose(equations.wrist, equations.reflectors, unknown);
    case Method::partial_pose:
      break;
  }
  const std::vector<NormalEquations> normal = normalByPosture(equations.reflectors);
  StiffnessEstimate estimate = partialPose(equations.reflectors, normal, unknown);
  // With several load steps a posture's rows share step 0: there the plain correction stands.
  const bool one_step = normal.size() == equations.reflectors.size();
  if (tracker != nullptr && one_step) {
    correctForNoise(normal, reflectorNoise(*tracker, arm, equations.reflectors), estimate);
  }
  return estimate;
}

JointVector MethodSolution::compliance(const LoadedArm& arm) const {
  switch (method) {
    case Method::complete_pose:
      return solveNormal(poseNormal(arm, tcp_in_flange).at(length), unknown);
    case Method::decoupled_partial_pose:
      return solveDecoupled(wristNormal(arm), reflectorNormal(arm), unknown);
    case Method::partial_pose:
      break;
  }
  return solveNormal(reflectorNormal(arm), unknown);
}

JointVector MethodSolution::solvedCompliance(LoadedArm& arm, bool finite_deflection) const {
  solveLoadedArm(arm, finite_deflection, [this](const LoadedArm& now) { return compliance(now); });
  return compliance(arm);
}

StiffnessEstimate MethodSolution::solvedEstimate(LoadedArm& arm, bool finite_deflection,
                                                 PointEquations* equations) const {
  solveLoadedArm(arm, finite_deflection, [this](const LoadedArm& now) { return compliance(now); });
  PointEquations settled;
  if (equations != nullptr || method == Method::decoupled_partial_pose) settled.wrist = wristPointEquations(arm);
  if (equations != nullptr || method != Method::complete_pose) settled.reflectors = reflectorEquations(arm);
  StiffnessEstimate estimated = estimate(arm, settled);
  if (equations != nullptr) *equations = std::move(settled);
  return estimated;
}

}  // namespace stiffscope::identification
