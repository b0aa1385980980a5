#include "core/identification/method_runs.h"

#include <fmt/format.h>

#include <utility>

#include "core/identification/judge_method.h"
#include "core/identification/method_solution.h"
#include "core/identification/posture_influence.h"
#include "core/identification/settled_frames.h"
#include "core/identification/shared_uncertainty.h"
#include "core/identification/unavailable.h"
#include "core/identification/wrist_leak.h"

namespace stiffscope {

namespace {

MethodResult& methodOf(Identification& result, Method which) {
  return result.methods[static_cast<std::size_t>(which)];
}

MethodSolution solutionOf(Method which, const MethodRuns& runs, const Identification& result) {
  return {which, result.frames.tcp_in_flange, result.characteristic_length.length, runs.unknown,
          runs.campaign.tracker ? &*runs.campaign.tracker : nullptr};
}

/// Solves a method, and gives the equations of the arm's points as it settles.
PointEquations solve(Method which, LoadedArm& arm, const MethodRuns& runs, Identification& result) {
  PointEquations equations;
  methodOf(result, which).estimate =
      solutionOf(which, runs, result).settledEstimate(arm, runs.options.finite_deflection, &equations);
  return equations;
}

/// The loaded arm in the calibrated geometry. Where no sweep gave stiffnesses for the own weight's sag,
/// calibration and stiffnesses are found in turns here, or the sag would be taken for geometry.
LoadedArm calibratedArm(const MethodRuns& runs, Identification& result) {
  LoadingGeometry start = runs.swept.geometry;
  const bool settle_sag = runs.swept.cases.empty() && result.frames.weight.links_known;
  const LoadReadings readings(runs.campaign, result.steps);
  for (int round = 0;; ++round) {
    result.calibration = calibrateGeometry(runs.campaign, start);
    if (!result.calibration.done) return runs.swept;
    LoadedArm arm =
        loadedArm(runs.campaign, readings, result.calibration.geometry, result.frames.wrist, result.steps);
    if (!settle_sag || round == kSagRounds || arm.cases.empty()) return arm;
    start.compliance = sagCompliance(runs.campaign, runs.options, arm);
  }
}

}  // namespace

void judgeJointsIn(const LoadedArm& arm, MethodRuns& runs, Identification& result) {
  result.identifiability = judgeJoints(arm.geometry, arm.cases, *runs.campaign.load_cell,
                                       reflectorEquations(arm), runs.options.trust);
  runs.unknown = result.identifiability.mask();
}

void runCompletePose(MethodRuns& runs, Identification& result) {
  MethodResult& out = methodOf(result, Method::complete_pose);
  out.reason = whyNoPositions(runs.campaign, runs.swept, runs.unknown);
  if (out.reason.empty()) out.reason = whyNoFlangePoses(runs.campaign, runs.swept);
  if (!out.reason.empty()) return;
  const Eigen::Vector3d tcp = result.frames.tcp_in_flange;
  result.characteristic_length = characteristicLength(runs.swept.cases, tcp);
  const double length = result.characteristic_length.length;
  PointEquations equations = solve(Method::complete_pose, runs.swept, runs, result);
  constexpr int kEvery = 5;
  PoseNormal sum;
  std::vector<CaseEquations> scaled;
  for (const CaseEquations& one : poseEquations(runs.swept, tcp)) {
    sum.add(one);
    scaled.push_back(normalised(one, length));
  }
  for (std::size_t i = 0; i < result.characteristic_length.curve.size(); i += kEvery) {
    const auto& [at, condition] = result.characteristic_length.curve[i];
    result.length_sensitivity.push_back({at, condition, solveNormal(sum.at(at), runs.unknown)});
  }
  judgeMethod(runs.swept.geometry, std::move(equations), normalByPosture(scaled), false, runs.options, out);
}

void runPartialPose(MethodRuns& runs, Identification& result) {
  MethodResult& out = methodOf(result, Method::partial_pose);
  LoadedArm own;  // in the calibrated geometry; differences are used in the swept one, as they are there
  LoadedArm& arm = runs.campaign.loading ? own : runs.swept;
  if (runs.campaign.loading) {
    own = calibratedArm(runs, result);
    if (!result.calibration.done) {
      out.reason = "the geometry cannot be calibrated: " + result.calibration.reason;
      return;
    }
  } else {
    result.calibration.reason =
        "the campaign has displacements only, no absolute positions: the URDF's geometry stands";
  }
  // No swept geometry to judge by: judge in this one.
  if (runs.unknown == JointMask{}) judgeJointsIn(arm, runs, result);
  out.reason = whyNoPositions(runs.campaign, arm, runs.unknown);
  if (!out.reason.empty()) return;
  PointEquations equations = solve(Method::partial_pose, arm, runs, result);
  std::vector<NormalEquations> normal = normalByPosture(equations.reflectors);
  judgeMethod(arm.geometry, std::move(equations), std::move(normal), false, runs.options, out);
  if (!runs.campaign.loading)
    settleArm(arm, false, [](const LoadedArm&) { return Vector6d(); });  // unloaded again
  if (runs.swept.cases.empty()) runs.calibrated = std::move(arm);
}

void runDecoupledPartialPose(MethodRuns& runs, Identification& result) {
  MethodResult& out = methodOf(result, Method::decoupled_partial_pose);
  out.reason = whyNoPositions(runs.campaign, runs.swept, runs.unknown);
  if (!out.reason.empty() && !runs.campaign.wrist_sweep) {
    out.reason += "; and P_wrist needs a wrist sweep (axes 4-6 moving) with three reflectors";
  }
  if (out.reason.empty()) out.reason = whyNoWristPoint(runs.campaign, runs.swept, result.frames.wrist);
  if (!out.reason.empty()) return;
  PointEquations equations = solve(Method::decoupled_partial_pose, runs.swept, runs, result);
  const WristCentre& wrist = result.frames.wrist;
  out.reason =
      whyNotDecoupled(wrist, wristLeak(runs.swept, wrist.centre_at_zero_in_r0, out.estimate.compliance));
  if (!out.reason.empty()) return;
  std::vector<NormalEquations> normal = normalByPosture(equations.wrist);
  judgeMethod(runs.swept.geometry, std::move(equations), std::move(normal), true, runs.options, out);
}

void addSharedUncertainty(const MethodRuns& runs, Identification& result) {
  std::vector<Method> swept;
  std::vector<ComplianceOf> solves;
  for (const Method which : kMethods) {
    MethodResult& method = methodOf(result, which);
    if (!method.available || (which == Method::partial_pose && result.calibration.done)) continue;
    swept.push_back(which);
    solves.emplace_back(
        [how = solutionOf(which, runs, result)](const LoadedArm& arm) { return how.compliance(arm); });
  }
  const std::vector<SweptParts> parts =
      sweptParts(runs.campaign, result.frames, runs.swept.geometry, result.steps, solves);
  for (std::size_t k = 0; k < swept.size(); ++k) {
    CovarianceParts& own = methodOf(result, swept[k]).estimate.parts;
    own.frames = parts[k].frames, own.wrist = parts[k].wrist;
  }
  MethodResult& partial = methodOf(result, Method::partial_pose);
  if (partial.available && result.calibration.done) {
    const MethodSolution how = solutionOf(Method::partial_pose, runs, result);
    partial.estimate.parts.geometry =
        calibratedPart(runs.campaign, result.calibration, result.frames.wrist, result.steps,
                       [&](const LoadedArm& arm) { return how.compliance(arm); });
  }
  for (MethodResult& method : result.methods) method.estimate.covariance = method.estimate.parts.total();
}

}  // namespace stiffscope
