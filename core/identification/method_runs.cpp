#include "core/identification/method_runs.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/estimate.h"
#include "core/identification/identification.h"
#include "core/identification/loaded_arm.h"
#include "core/identification/method_solution.h"
#include "core/identification/remarks.h"
#include "core/preparation/subsample.h"

namespace stiffscope::identification {

/// Judges a solved method, `out.estimate`, on all postures and on subsets, and fills the rest of `out`. `equations` are
/// those of the arm's points, `normal` the method's normal equations, one a posture (byPosture); the decoupled method's
/// are those of P_wrist, and its second stage takes the reflectors'.
void evaluateMethod(const frames::LoadingGeometry& geometry, PointEquations equations,
                    std::vector<NormalEquations> normal, bool decoupled, const IdentifyOptions& options,
                    MethodResult& out);

// Why a method cannot be had, and what measurement would make it available; empty where nothing stands in
// its way.

/// What all methods need: postures read unloaded and loaded, placed in R0, and a joint that the load turns.
Remark whyNoPositions(const campaign::Campaign& campaign, const LoadedArm& arm, const robot::JointMask& unknown);

/// Complete Pose: the flange's pose in every posture. The arm has cases.
Remark whyNoFlangePoses(const campaign::Campaign& campaign, const LoadedArm& arm);

/// Decoupled Partial Pose: P_wrist in every posture.
Remark whyNoWristPoint(const campaign::Campaign& campaign, const LoadedArm& arm, const frames::WristCentre& wrist);

/// Decoupled Partial Pose: axes that meet nearly enough; `leak` is wristLeak's share.
Remark whyNotDecoupled(const frames::WristCentre& wrist, double leak);

namespace {

Compensation compensationBy(const StiffnessEstimate& estimate, const DeflectionJudge& judge,
                            const SubsetJudgement& subsets) {
  return {judge.compensated(estimate.compliance), subsets.compensated, meanOverSubsets(subsets.held_out).sd};
}

/// Mean over a case's points of what is left of the displacement; `by_posture` judges the same, which with one load
/// step is a case each.
std::vector<double> residualByCase(const std::vector<CaseEquations>& rows, const DeflectionJudge& by_posture,
                                   const JointVector& compliance) {
  std::optional<DeflectionJudge> by_case;
  const DeflectionJudge& judge = by_posture.postures() == rows.size() ? by_posture : by_case.emplace(rows);
  std::vector<double> left = judge.residual(compliance);
  for (std::size_t i = 0; i < left.size(); ++i) left[i] /= judge.pointsOf(i);
  return left;
}

}  // namespace

void evaluateMethod(const frames::LoadingGeometry& geometry, PointEquations equations,
                    std::vector<NormalEquations> normal, bool decoupled, const IdentifyOptions& options,
                    MethodResult& out) {
  out.available = true;
  out.geometry = geometry;
  out.wrist_rows = std::move(equations.wrist);
  out.target_rows = std::move(equations.reflectors);
  if (options.estimates_only) return;
  SubsetMethod subset;
  subset.unknown = out.estimate.identifiable;
  subset.normal = std::move(normal);
  if (decoupled) subset.reflectors = normalByPosture(out.target_rows);
  if (!out.wrist_rows.empty()) subset.at_wrist = DeflectionJudge::byPosture(out.wrist_rows);
  subset.at_targets = DeflectionJudge::byPosture(out.target_rows);
  out.subsets = studySubsets(subset, options.subsets);

  out.bootstrap = bootstrapPostures(subset, options.bootstrap);

  if (!out.wrist_rows.empty()) {
    out.at_wrist = compensationBy(out.estimate, subset.at_wrist, out.subsets.at_wrist);
    out.wrist_residual = residualByCase(out.wrist_rows, subset.at_wrist, out.estimate.compliance);
  }
  out.at_targets = compensationBy(out.estimate, subset.at_targets, out.subsets.at_targets);
  out.target_residual = residualByCase(out.target_rows, subset.at_targets, out.estimate.compliance);
}

Remark whyNoPositions(const campaign::Campaign& campaign, const LoadedArm& arm, const robot::JointMask& unknown) {
  if (arm.cases.empty()) {
    if (!campaign.loading && campaign.displacements && !arm.geometry.displacements_in_r0) {
      return Remark(RemarkId::displacements_not_placed);
    }
    return Remark(campaign.loading && !arm.geometry.r0_from_loading ? RemarkId::loading_not_placed
                                                                    : RemarkId::no_posture_in_both_states);
  }
  if (std::none_of(unknown.begin(), unknown.end(), [](bool one) { return one; })) {
    return Remark(RemarkId::no_joint_turned);
  }
  return {};
}

Remark whyNoFlangePoses(const campaign::Campaign& campaign, const LoadedArm& arm) {
  if (arm.hasFlangePoses()) return {};
  if (arm.cases.front().absolute) {
    return Remark(RemarkId::flange_pose_not_everywhere);
  }
  return Remark(RemarkId::flange_pose_by_displacements, campaign.targets.size());
}

Remark whyNoWristPoint(const campaign::Campaign& campaign, const LoadedArm& arm, const frames::WristCentre& wrist) {
  if (!arm.wrist.empty()) return {};
  const Remark reason = wrist.measured ? Remark(RemarkId::wrist_point_not_everywhere)
                                       : Remark(RemarkId::wrist_centre_not_measured, wrist.reason);
  const int joints = campaign.robot.joints();
  return campaign.wrist_sweep ? reason
                              : Remark(RemarkId::wrist_sweep_wanted, reason, robot::armJointsOf(joints) + 1, joints);
}

namespace {

std::vector<double> missesOf(const frames::WristCentre& wrist) {
  std::vector<double> misses;
  for (const frames::WristAxesMiss& one : wrist.misses) misses.push_back(one.distance);
  return misses;
}

}  // namespace

Remark whyNotDecoupled(const frames::WristCentre& wrist, double leak) {
  if (wrist.offset()) return Remark(RemarkId::wrist_is_offset, wrist.misses.front().first + 1, wrist.apart);
  if (leak <= kWristLeakBorne) return {};
  return Remark(RemarkId::wrist_axes_apart, missesOf(wrist), leak, kWristLeakBorne, wrist.misses.front().first + 1);
}

namespace {

MethodResult& methodOf(Identification& result, Method which) { return result.methods[static_cast<std::size_t>(which)]; }

MethodSolution solutionOf(Method which, const MethodRuns& runs, const Identification& result) {
  return {which, result.frames.tcp_in_flange, result.characteristic_length.length, runs.unknown,
          runs.campaign.tracker ? &*runs.campaign.tracker : nullptr};
}

/// Solves a method, and gives the equations of the arm's points as it settles.
PointEquations solve(Method which, LoadedArm& arm, const MethodRuns& runs, Identification& result) {
  PointEquations equations;
  methodOf(result, which).estimate =
      solutionOf(which, runs, result).solvedEstimate(arm, runs.options.finite_deflection, &equations);
  return equations;
}

/// The loaded arm in the calibrated geometry. Where no sweep gave stiffnesses for the own weight's sag,
/// calibration and stiffnesses are found in turns here, or the sag would be taken for geometry.
LoadedArm calibratedArm(const MethodRuns& runs, Identification& result) {
  frames::LoadingGeometry start = runs.swept.geometry;
  const bool settle_sag = runs.swept.cases.empty() && result.frames.weight.links_known;
  const LoadReadings readings(runs.campaign, result.steps);
  for (int round = 0;; ++round) {
    result.calibration = frames::calibrateGeometry(runs.campaign, start);
    if (!result.calibration.done) return runs.swept;
    LoadedArm arm = loadedArm(runs.campaign, readings, result.calibration.geometry, result.frames.wrist, result.steps);
    if (!settle_sag || round == kSagRounds || arm.cases.empty()) return arm;
    start.compliance = sagCompliance(runs.campaign, runs.options, arm);
  }
}

}  // namespace

void evaluateIdentifiabilityIn(const LoadedArm& arm, MethodRuns& runs, Identification& result) {
  result.identifiability = evaluateIdentifiability(arm.geometry, arm.cases, *runs.campaign.load_cell,
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
  std::vector<CaseEquations> scaled;
  out.pose_rows = poseEquations(runs.swept, tcp);
  for (const CaseEquations& one : out.pose_rows) scaled.push_back(normalised(one, length));
  evaluateMethod(runs.swept.geometry, std::move(equations), normalByPosture(scaled), false, runs.options, out);
  if (!runs.options.estimates_only) studyLengths(runs.swept.cases, runs.options, result);
}

void runPartialPose(MethodRuns& runs, Identification& result) {
  MethodResult& out = methodOf(result, Method::partial_pose);
  LoadedArm own;  // in the calibrated geometry; differences are used in the swept one, as they are there
  LoadedArm& arm = runs.campaign.loading ? own : runs.swept;
  if (runs.campaign.loading) {
    own = calibratedArm(runs, result);
    if (!result.calibration.done) {
      out.reason = Remark(RemarkId::geometry_not_calibrated, result.calibration.reason);
      return;
    }
  } else {
    result.calibration.reason = Remark(RemarkId::displacements_by_model_only);
  }
  // No swept geometry to judge by: judge in this one.
  if (std::find(runs.unknown.begin(), runs.unknown.end(), true) == runs.unknown.end())
    evaluateIdentifiabilityIn(arm, runs, result);
  out.reason = whyNoPositions(runs.campaign, arm, runs.unknown);
  if (!out.reason.empty()) return;
  PointEquations equations = solve(Method::partial_pose, arm, runs, result);
  std::vector<NormalEquations> normal = normalByPosture(equations.reflectors);
  // A long day's cases are a tenth of its memory, and what follows takes the most of all.
  if (runs.campaign.loading && !runs.swept.cases.empty()) std::vector<LoadCase>().swap(own.cases);
  evaluateMethod(arm.geometry, std::move(equations), std::move(normal), false, runs.options, out);
  if (!runs.campaign.loading)
    solveLoadedArm(arm, false, [](const LoadedArm&) { return JointVector(); });  // unloaded again
  if (runs.swept.cases.empty()) runs.calibrated = std::move(arm);
}

void runDecoupledPartialPose(MethodRuns& runs, Identification& result) {
  MethodResult& out = methodOf(result, Method::decoupled_partial_pose);
  out.reason = whyNoPositions(runs.campaign, runs.swept, runs.unknown);
  if (!out.reason.empty() && !runs.campaign.wrist_sweep) {
    const int joints = runs.campaign.robot.joints();
    out.reason = Remark(RemarkId::wrist_sweep_wanted_too, out.reason, robot::armJointsOf(joints) + 1, joints);
  }
  if (out.reason.empty()) out.reason = whyNoWristPoint(runs.campaign, runs.swept, result.frames.wrist);
  if (!out.reason.empty()) return;
  PointEquations equations = solve(Method::decoupled_partial_pose, runs.swept, runs, result);
  const frames::WristCentre& wrist = result.frames.wrist;
  out.reason = whyNotDecoupled(wrist, wristLeak(runs.swept, wrist.centre_at_zero_in_r0, out.estimate.compliance));
  if (!out.reason.empty()) return;
  std::vector<NormalEquations> normal = normalByPosture(equations.wrist);
  evaluateMethod(runs.swept.geometry, std::move(equations), std::move(normal), true, runs.options, out);
}

void addSharedUncertainty(const MethodRuns& runs, Identification& result) {
  std::vector<Method> swept;
  std::vector<ComplianceOf> solves;
  for (const Method which : kMethods) {
    MethodResult& method = methodOf(result, which);
    if (!method.available || (which == Method::partial_pose && result.calibration.done)) continue;
    swept.push_back(which);
    solves.emplace_back([how = solutionOf(which, runs, result)](const LoadedArm& arm) { return how.compliance(arm); });
  }
  std::optional<campaign::Campaign> some;
  if (runs.campaign.pose_ids.size() > preparation::kMostAveraged)
    some = preparation::evenlySpread(runs.campaign, preparation::kMostAveraged, preparation::kMostSwept, result.steps);
  const campaign::Campaign& judged = some ? *some : runs.campaign;
  const std::vector<SweptParts> parts = sweptParts(judged, result.frames, runs.swept.geometry, result.steps, solves);
  for (std::size_t k = 0; k < swept.size(); ++k) {
    CovarianceParts& own = methodOf(result, swept[k]).estimate.parts;
    own.frames = parts[k].frames, own.wrist = parts[k].wrist;
  }
  MethodResult& partial = methodOf(result, Method::partial_pose);
  if (partial.available && result.calibration.done) {
    const MethodSolution how = solutionOf(Method::partial_pose, runs, result);
    partial.estimate.parts.geometry = calibratedPart(judged, result.calibration, result.frames.wrist, result.steps,
                                                     [&](const LoadedArm& arm) { return how.compliance(arm); });
  }
  for (MethodResult& method : result.methods) method.estimate.covariance = method.estimate.parts.total();
}

}  // namespace stiffscope::identification
