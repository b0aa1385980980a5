#include "core/audit/audit_input.h"

#include "core/identification/method_solution.h"
#include "core/preparation/repeatability.h"

namespace stiffscope::audit {

namespace {

frames::SagModel sagOf(const Evidence& evidence) {
  const frames::Frames& frames = evidence.frames;
  if (!frames.sag_removed) return {};
  return frames::SagModel(frames.arm.arm, frames.weight, evidence.arm.geometry.compliance,
                  frames.targets_in_r0_at_zero, frames.arm.r0_from_points.inverse());
}

}  // namespace

Evidence gatherEvidence(const preparation::PreparedCampaign& prepared) {
  Evidence evidence{prepared.campaign};
  evidence.drift = prepared.preparation.drift;
  evidence.station = prepared.drift.rounds;
  evidence.scatter = prepared.scatter;
  evidence.noise = preparation::declaredNoise(evidence.campaign);
  evidence.states = campaign::statePoints(evidence.campaign);
  identification::SettledDay day = identification::settleDay(evidence.campaign);
  evidence.step = day.step;
  evidence.frames = std::move(day.frames);
  evidence.arm = std::move(day.arm);
  evidence.rigid = frames::rigidPoints(evidence.campaign, sagOf(evidence));
  evidence.absolute = fitAbsolutePositions(evidence.campaign, evidence.frames, evidence.arm.geometry,
                                           evidence.states, evidence.noise);
  return evidence;
}

}  // namespace stiffscope::audit
