#include "core/audit/evidence.h"

#include "core/audit/working_noise.h"
#include "core/identification/settled_frames.h"

namespace stiffscope {

namespace {

SagModel sagOf(const Evidence& evidence) {
  const Frames& frames = evidence.frames;
  if (!frames.sag_removed) return {};
  return SagModel(frames.arm.arm, frames.weight, evidence.arm.geometry.compliance,
                  frames.targets_in_r0_at_zero, frames.arm.r0_from_points.inverse());
}

}  // namespace

Evidence gatherEvidence(Campaign campaign, const PreparedCampaign& found) {
  Evidence evidence;
  evidence.campaign = std::move(campaign);
  evidence.drift = found.preparation.drift;
  evidence.station = found.station;
  evidence.scatter = found.scatter;
  if (declaredNoise(evidence.campaign)) {
    evidence.campaign.tracker = asNoisyAs(*evidence.campaign.tracker, noiseFactors(evidence.scatter));
    evidence.noise = trackerNoise(*evidence.campaign.tracker);
  }
  evidence.states = statePoints(evidence.campaign);
  SettledDay day = settleDay(evidence.campaign);
  evidence.step = day.step;
  evidence.frames = std::move(day.frames);
  evidence.arm = std::move(day.arm);
  evidence.rigid = rigidPoints(evidence.campaign, sagOf(evidence));
  evidence.absolute = fitAbsolutePositions(evidence.campaign, evidence.frames, evidence.arm.geometry,
                                           evidence.states, evidence.noise);
  return evidence;
}

}  // namespace stiffscope
