#include "app/view/under_load_step.h"

#include "core/identification/loaded_arm.h"

namespace stiffscope {

namespace {

/// The geometry in which the cases of `identified` are shown: the swept one, or Partial Pose's calibrated one
/// where no sweeps place the readings.
LoadingGeometry shownGeometry(const Campaign& campaign, const Identification& identified) {
  for (const Method method : {Method::decoupled_partial_pose, Method::complete_pose}) {
    if (identified.of(method).available) return identified.of(method).geometry;
  }
  const MethodResult& partial = identified.of(Method::partial_pose);
  const Vector6d sag =
      partial.available ? Vector6d(partial.estimate.compliance.cwiseMax(0.0)) : Vector6d::Zero();
  LoadingGeometry swept = sweptGeometry(campaign, identified.frames, sag);
  if (partial.available && loadCases(campaign, swept, identified.step).empty()) return partial.geometry;
  return swept;
}

/// `rows` of `from`'s cases in the order of `to`'s, by posture.
std::vector<CaseEquations> alignedRows(const std::vector<CaseEquations>& rows,
                                       const std::vector<LoadCase>& from, const std::vector<LoadCase>& to) {
  std::vector<CaseEquations> aligned;
  for (const LoadCase& wanted : to) {
    aligned.emplace_back();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (from[i].pose == wanted.pose) aligned.back() = rows[i];
    }
  }
  return aligned;
}

}  // namespace

Identification underLoadStep(const Campaign& campaign, const Identification& identified, int step) {
  Identification other;
  other.step = step;
  other.steps = {step};
  other.frames = identified.frames;
  other.finite_deflection = identified.finite_deflection;
  const LoadedArm shown = loadedArm(campaign, shownGeometry(campaign, identified), identified.frames.wrist,
                                    {step}, &other.left_out);
  other.cases = shown.cases;
  other.wrist = shown.wrist;
  for (const Method which : kMethods) {
    const MethodResult& known = identified.of(which);
    if (!known.available) continue;
    LoadedArm arm = loadedArm(campaign, known.geometry, identified.frames.wrist, {step});
    // Nothing is solved: the known estimate stands in for every round's.
    settleArm(arm, identified.finite_deflection, [&](const LoadedArm&) { return known.estimate.compliance; });
    MethodResult& out = other.methods[static_cast<std::size_t>(which)];
    out.available = true;
    out.estimate = known.estimate;
    out.geometry = known.geometry;
    out.target_rows = alignedRows(reflectorEquations(arm), arm.cases, shown.cases);
    if (!arm.wrist.empty()) out.wrist_rows = alignedRows(wristPointEquations(arm), arm.cases, shown.cases);
  }
  return other;
}

}  // namespace stiffscope
