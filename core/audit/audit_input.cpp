#include "core/audit/audit_input.h"

#include "core/audit/limits.h"
#include "core/identification/method_solution.h"
#include "core/numerics/parallel.h"
#include "core/preparation/repeatability.h"

namespace stiffscope::audit {

namespace {

frames::SagModel sagOf(const AuditInput& input) {
  const frames::Frames& frames = input.frames;
  if (!frames.sag_removed) return {};
  return frames::SagModel(frames.arm.arm, frames.weight, input.arm.geometry.compliance, frames.targets_in_r0_at_zero,
                          frames.arm.r0_from_points.inverse());
}

}  // namespace

AuditInput auditInput(const preparation::PreparedCampaign& prepared) {
  AuditInput input{prepared.campaign};
  input.drift = prepared.preparation.drift;
  input.station = prepared.drift.rounds;
  input.rail = prepared.rail;
  input.stations = prepared.preparation.stations;
  input.scatter = prepared.scatter;
  input.noise = preparation::declaredNoise(input.campaign);
  input.states = campaign::statePoints(input.campaign);
  const auto solve = [&] {
    identification::SolvedDay day = identification::solveDay(input.campaign);
    input.step = day.step;
    input.frames = std::move(day.frames);
    input.arm = std::move(day.arm);
    input.rigid = frames::rigidPoints(input.campaign, sagOf(input));
    input.absolute = fitAbsolutePositions(input.campaign, input.frames, input.arm.geometry, input.states, input.noise);
  };
  // Neither asks what the other finds.
  numerics::onAllCores(2, [&](std::size_t part) {
    if (part == 0) return solve();
    input.model = mistakes::findMistakes(input.campaign);
    input.controller = mistakes::controllerAgreement(input.campaign, kControllerDigits);
  });
  return input;
}

}  // namespace stiffscope::audit
