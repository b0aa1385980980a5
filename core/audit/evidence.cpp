#include "core/audit/evidence.h"

#include "core/audit/working_noise.h"
#include "core/identification/settled_frames.h"

namespace stiffscope {

namespace {

/// The loaded arm where the campaign has what it takes; else the frames alone.
void settle(Evidence& evidence) {
  const Campaign& campaign = evidence.campaign;
  if (campaign.states && campaign.load_cell) evidence.step = heaviestStep(campaign);
  if (evidence.step && (campaign.loading || campaign.displacements)) {
    SettledFrames settled = settleFrames(campaign, {*evidence.step}, {});
    evidence.frames = std::move(settled.frames);
    evidence.arm = std::move(settled.arm);
    return;
  }
  evidence.frames = measureFrames(campaign);
  evidence.arm.geometry = sweptGeometry(campaign, evidence.frames, Vector6d::Zero());
}

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
  settle(evidence);
  evidence.rigid = rigidPoints(evidence.campaign, sagOf(evidence));
  evidence.absolute = fitAbsolutePositions(evidence.campaign, evidence.frames, evidence.arm.geometry,
                                           evidence.states, evidence.noise);
  return evidence;
}

}  // namespace stiffscope
