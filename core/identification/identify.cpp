#include "core/identification/identify.h"

#include "core/identification/cautions.h"
#include "core/identification/describe_loads.h"
#include "core/identification/load_step.h"
#include "core/identification/method_runs.h"
#include "core/identification/settled_frames.h"

namespace stiffscope {

Frames settledFrames(const Campaign& campaign) {
  if (!campaign.loading || !whatLoadsLack(campaign).empty() || !heaviestStep(campaign)) {
    return measureFrames(campaign);
  }
  return settleFrames(campaign, chosenStep(campaign, {}), {}).frames;
}

Identification identify(const Campaign& campaign, const IdentifyOptions& options) {
  Identification result;
  result.step = chosenStep(campaign, options.step);
  result.finite_deflection = options.finite_deflection;
  SettledFrames settled = settleFrames(campaign, result.step, options);
  result.frames = std::move(settled.frames);
  result.left_out = std::move(settled.left_out);
  MethodRuns runs{campaign, options, std::move(settled.arm), {}, {}};
  judgeJointsIn(runs.swept, runs, result);
  runCompletePose(runs, result);
  runPartialPose(runs, result);
  runDecoupledPartialPose(runs, result);
  describeLoads(campaign, runs.swept.cases.empty() ? runs.calibrated : runs.swept, result);
  result.cautions = cautionsOf(result);
  return result;
}

Identification framesAlone(const Campaign& campaign) {
  Identification result;
  const std::string lacking = whatLoadsLack(campaign);
  result.frames = settledFrames(campaign);
  for (MethodResult& method : result.methods) method.reason = lacking;
  for (JointIdentifiability& joint : result.identifiability.joints) joint.reason = lacking;
  result.calibration.reason = lacking;
  result.cautions = cautionsOf(result);
  return result;
}

}  // namespace stiffscope
