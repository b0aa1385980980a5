#include "core/audit/audit_input.h"

#include "core/audit/limits.h"
#include "core/frames/geometry_calibration.h"
#include "core/identification/method_solution.h"
#include "core/numerics/parallel.h"
#include "core/preparation/repeatability.h"

namespace stiffscope::audit {

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
    const frames::SagModel sag =
        input.frames.sag_removed ? frames::sagOf(input.frames, input.arm.geometry.compliance) : frames::SagModel();
    input.rigid = frames::rigidPoints(input.campaign, sag);
    input.absolute = fitAbsolutePositions(input.campaign, input.frames, input.arm.geometry, input.states, input.noise);
    if (!input.step || !input.campaign.loading || input.arm.geometry.r0_from_loading) return;
    const frames::GeometryCalibration found = frames::calibrateGeometry(input.campaign, input.arm.geometry);
    input.not_calibrated = found.reason;
    if (found.done)
      input.arm = identification::loadedArm(input.campaign, found.geometry, input.frames.wrist, {*input.step});
  };
  // Neither asks what the other finds.
  numerics::onAllCores(2, [&](std::size_t part) {
    if (part == 0) return solve();
    input.model = mistakes::findMistakes(input.campaign);
    if (input.campaign.load_cell && input.campaign.states) input.zero = mistakes::cellZero(input.campaign);
    input.controller = mistakes::controllerAgreement(input.campaign, kControllerDigits);
  });
  return input;
}

}  // namespace stiffscope::audit
