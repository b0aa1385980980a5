#include "core/identification/identify.h"

#include "core/identification/cautions.h"
#include "core/identification/describe_loads.h"
#include "core/identification/load_step.h"
#include "core/identification/method_runs.h"
#include "core/identification/posture_influence.h"
#include "core/identification/settled_frames.h"
#include "core/identification/without_postures.h"

namespace stiffscope {

Frames settledFrames(const Campaign& campaign) {
  if (!campaign.loading || !whatLoadsLack(campaign).empty() || !heaviestStep(campaign)) {
    return measureFrames(campaign);
  }
  return settleFrames(campaign, {chosenStep(campaign, {})}, {}).frames;
}

namespace {

/// One fit to each posture's reflectors by all joints together, whatever the methods do: a wrong reading shows there.
std::vector<OutlyingPosture> outlyingOf(const LoadedArm& arm, const JointMask& unknown) {
  return outlyingPostures(byPosture(reflectorEquations(arm)), unknown);
}

Identification identifyOnce(const Campaign& campaign, const IdentifyOptions& options) {
  Identification result;
  result.step = chosenStep(campaign, options.step);
  result.steps = options.all_steps ? loadedSteps(campaign) : std::vector<int>{result.step};
  result.finite_deflection = options.finite_deflection;
  SettledFrames settled = settleFrames(campaign, result.steps, options);
  result.frames = std::move(settled.frames);
  result.left_out = std::move(settled.left_out);
  MethodRuns runs{campaign, options, std::move(settled.arm), {}, {}};
  judgeJointsIn(runs.swept, runs, result);
  runCompletePose(runs, result);
  runPartialPose(runs, result);
  runDecoupledPartialPose(runs, result);
  addSharedUncertainty(runs, result);
  LoadedArm& shown = runs.swept.cases.empty() ? runs.calibrated : runs.swept;
  result.outlying = outlyingOf(shown, runs.unknown);
  describeLoads(campaign, std::move(shown), result);
  return result;
}

}  // namespace

Identification identify(const Campaign& campaign, const IdentifyOptions& options) {
  Identification result = identifyOnce(campaign, options);
  if (options.robust && !result.outlying.empty()) {
    const std::vector<OutlyingPosture> outlying = result.outlying;
    result = identifyOnce(withoutPostures(campaign, outlying), options);
    result.outlying = outlying;
    result.robust = true;
    nameLeftOut(campaign, outlying, result.left_out);
  }
  result.cautions = cautionsOf(campaign, result);
  return result;
}

Identification framesAlone(const Campaign& campaign) {
  Identification result;
  const std::string lacking = whatLoadsLack(campaign);
  result.frames = settledFrames(campaign);
  for (MethodResult& method : result.methods) method.reason = lacking;
  for (JointIdentifiability& joint : result.identifiability.joints) joint.reason = lacking;
  result.calibration.reason = lacking;
  result.cautions = cautionsOf(campaign, result);
  return result;
}

}  // namespace stiffscope
