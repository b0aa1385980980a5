#include "core/audit/evidence.h"

#include "core/audit/station_jumps.h"
#include "core/identification/settled_frames.h"

namespace stiffscope {

namespace {

/// The loaded arm where the campaign has what it takes; else the frames alone.
void settle(Evidence& evidence) {
  const Campaign& campaign = evidence.campaign;
  if (campaign.states && campaign.load_cell) evidence.step = heaviestStep(campaign);
  if (evidence.step && (campaign.loading || campaign.displacements)) {
    SettledFrames settled = settleFrames(campaign, *evidence.step, {});
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

bool declared(const Tracker& tracker) {
  return tracker.range_fixed + tracker.range_per_m > 0.0 && tracker.angle_fixed + tracker.angle_per_m > 0.0;
}

}  // namespace

Evidence gatherEvidence(const Campaign& original, const Campaign& screened) {
  Evidence evidence{original, screened, {}, {}, {}, {}, {}, {}, {}, {}};
  if (original.tracker && declared(*original.tracker)) evidence.noise = trackerNoise(*original.tracker);
  evidence.station = stationMotion(evidence.campaign, evidence.noise);
  if (evidence.station.moved) findJumps(evidence.campaign, *evidence.noise, evidence.station);
  if (evidence.station.moved) takeOffDrift(evidence.station, evidence.campaign);
  evidence.states = statePoints(evidence.campaign, evidence.noise);
  settle(evidence);
  evidence.rigid = rigidPoints(evidence.campaign, sagOf(evidence));
  evidence.absolute = fitAbsolutePositions(evidence.campaign, evidence.frames, evidence.arm.geometry,
                                           evidence.states, evidence.noise);
  return evidence;
}

}  // namespace stiffscope
