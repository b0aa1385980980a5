#include "core/identification/identify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/identification/estimate.h"
#include "core/identification/identification.h"
#include "core/identification/load_case.h"
#include "core/identification/method_runs.h"
#include "core/identification/method_solution.h"
#include "core/identification/outliers.h"
#include "core/identification/shown_first.h"
#include "core/identification/warnings.h"

namespace stiffscope::identification {

double geometricStiffnessShare(const LoadedArm& arm, const JointVector& compliance) {
  const auto plain = jointTorques(arm.cases);
  const auto full = jointTorquesWithGeometricStiffness(arm.geometry, arm.cases, compliance);
  double change = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    change += (full[i] - plain[i]).squaredNorm();
    whole += plain[i].squaredNorm();
  }
  return whole > 0.0 ? std::sqrt(change / whole) : 0.0;
}

void describeLoads(const campaign::Campaign& campaign, LoadedArm shown, Identification& result) {
  for (const WristMove& move : shown.wrist) result.wrist_displacement.push_back(move.displacement().norm());
  for (const LoadCase& load_case : shown.cases) {
    double sum = 0.0;
    for (const TargetMove& move : load_case.targets) sum += move.displacement().norm();
    result.target_displacement.push_back(sum / static_cast<double>(load_case.targets.size()));
    result.servo_change = std::max(result.servo_change, load_case.servo.cwiseAbs().maxCoeff());
  }
  result.noise = noiseShare(campaign, shown.geometry, shown.cases, shown.wrist, result.frames.wrist.radii,
                            result.frames.wrist.centre_at_zero_in_r0);
  const MethodResult& reference = result.of(bestMethod(result));
  if (reference.available) {
    result.geometric_stiffness_share = geometricStiffnessShare(shown, reference.estimate.compliance);
  }
  result.geometry = std::move(shown.geometry);
  result.cases = std::move(shown.cases);
  result.wrist = std::move(shown.wrist);
}

IdentifyOptions valuesOnly(IdentifyOptions options) {
  options.subsets.size = std::numeric_limits<int>::max();
  options.bootstrap.draws = 0;
  options.robust = false;
  return options;
}

IdentifyOptions estimatesOnly(IdentifyOptions options) {
  options = valuesOnly(std::move(options));
  options.estimates_only = true;
  return options;
}

frames::Frames solvedFrames(const campaign::Campaign& campaign) {
  if (!campaign.loading || !whatLoadsLack(campaign).empty() || !heaviestStep(campaign)) {
    return frames::refineByKnownStiffness(campaign, frames::measureFrames(campaign));
  }
  return solveFrames(campaign, {chosenStep(campaign, {})}, {}).frames;
}

namespace {

/// One fit to each posture's reflectors by all joints together, whatever the methods do: a wrong reading shows there.
std::vector<OutlyingPosture> outlyingOf(const LoadedArm& arm, const robot::JointMask& unknown) {
  return outlyingPostures(byPosture(reflectorEquations(arm)), unknown);
}

/// Gears by their two encoders, in the geometry that is shown and with K_c by the joints as the best method sees them.
void addTransmission(const campaign::Campaign& campaign, Identification& result) {
  if (!campaign.load_cell || !hasSecondEncoders(campaign)) return;
  const MethodResult& best = result.of(bestMethod(result));
  JointVector compliance = JointVector::Zero(campaign.robot.joints());
  if (best.available && result.finite_deflection) compliance = best.estimate.compliance;
  GeometryPart by_axes;
  if (campaign.loading && result.geometry.r0_from_loading) {
    by_axes = [&](const GearsIn& gears) {
      const ComplianceOf solve = [&](const LoadedArm& arm) { return gears(arm.geometry); };
      return sweptParts(campaign, result.frames, result.geometry, {result.step}, {solve}).front().frames;
    };
  }
  result.transmission = measureTransmission(campaign, result.geometry, compliance, by_axes);
}

Identification identifyOnce(const campaign::Campaign& campaign, const IdentifyOptions& options) {
  Identification result(campaign.robot.joints());
  result.step = chosenStep(campaign, options.step);
  result.steps = options.all_steps ? loadedSteps(campaign) : std::vector<int>{result.step};
  result.finite_deflection = options.finite_deflection;
  SolvedFrames settled = solveFrames(campaign, result.steps, options);
  result.frames = std::move(settled.frames);
  result.left_out = std::move(settled.left_out);
  MethodRuns runs{campaign, options, std::move(settled.arm), {}, {}};
  evaluateIdentifiabilityIn(runs.swept, runs, result);
  if (!options.for_frames) {
    runCompletePose(runs, result);
    runPartialPose(runs, result);
  }
  runDecoupledPartialPose(runs, result);
  if (options.for_frames && !result.of(Method::decoupled_partial_pose).available) runPartialPose(runs, result);
  if (!options.estimates_only) addSharedUncertainty(runs, result);
  result.shown_first = methodShownFirst(result, options.papers_choice);
  LoadedArm& shown = runs.swept.cases.empty() ? runs.calibrated : runs.swept;
  if (!options.estimates_only) result.outlying = outlyingOf(shown, runs.unknown);
  describeLoads(campaign, std::move(shown), result);
  addTransmission(campaign, result);
  return result;
}

}  // namespace

Identification identify(const campaign::Campaign& campaign, const IdentifyOptions& options) {
  Identification result = identifyOnce(campaign, options);
  if (options.robust && !result.outlying.empty()) {
    const std::vector<OutlyingPosture> outlying = result.outlying;
    result = identifyOnce(withoutPostures(campaign, outlying), options);
    result.outlying = outlying;
    result.robust = true;
    nameLeftOut(campaign, outlying, result.left_out);
  }
  result.cautions = warningsOf(campaign, result);
  return result;
}

Identification framesAlone(const campaign::Campaign& campaign) {
  Identification result(campaign.robot.joints());
  const Remark lacking = whatLoadsLack(campaign);
  result.frames = solvedFrames(campaign);
  for (MethodResult& method : result.methods) method.reason = lacking;
  for (JointIdentifiability& joint : result.identifiability.joints) joint.reason = lacking;
  result.calibration.reason = lacking;
  if (campaign.load_cell && hasSecondEncoders(campaign)) {
    result.geometry = frames::sweptGeometry(campaign, result.frames, JointVector::Zero(campaign.robot.joints()));
    addTransmission(campaign, result);
  }
  result.cautions = warningsOf(campaign, result);
  return result;
}

}  // namespace stiffscope::identification
