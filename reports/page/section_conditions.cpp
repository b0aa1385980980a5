#include <fmt/format.h>

#include "core/input/units.h"
#include "reports/page/html_table.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"
#include "reports/page/sections.h"
#include "reports/page/with_micro.h"
#include "reports/text/preparation_text.h"

namespace stiffscope::page {

namespace {

void add(RowGroup& group, const char* name, const std::string& text) {
  if (!text.empty()) group.rows.push_back({name, text});
}

/// A text of the campaign; empty stays empty, so that its row is left out.
std::string own(const std::string& text) { return text.empty() ? text : asIs(text); }

std::string trackerWords(const Tracker& tracker) {
  return fmt::format(
      "{}; one sigma {} µm + {} µm/m along the beam, {} µm + {} µm/m across it", asIs(tracker.model),
      significant(tracker.range_fixed / kMicrometre, 2), significant(tracker.range_per_m / kMicrometre, 2),
      significant(tracker.angle_fixed / kMicrometre, 2), significant(tracker.angle_per_m / kMicrometre, 2));
}

std::string loadWords(const Identification& result) {
  const std::string force =
      fmt::format("load step {}, mean force {} N", result.step, fixed(meanForce(result), 0));
  const double angle_deg = result.identifiability.gravity_angle_rms / kDegree;
  return fmt::format("{}; {} (within {}° of gravity, rms)", force,
                     result.identifiability.load_hangs ? "it hangs" : "it pulls aslant",
                     significant(angle_deg, 2));
}

std::string deflectionWords(const Identification& result) {
  if (!result.finite_deflection)
    return "small deflections: K_{c} neglected, Jacobians at the unloaded posture";
  return fmt::format(
      "finite: K_{{c}} of (4) included (it changes the joint torques by {}), Jacobians at the middle of the "
      "displacement",
      percent(result.geometric_stiffness_share, 2));
}

std::string calibrationWords(const GeometryCalibration& calibration) {
  if (!calibration.done) return fmt::format("not calibrated: {}", calibration.reason);
  return fmt::format(
      "{} parameters from {} unloaded positions; rms {} mm before, {} mm after, per coordinate",
      calibration.parameters, calibration.positions, significant(calibration.rms_before / kMillimetre, 3),
      significant(calibration.rms_after / kMillimetre, 3));
}

RowGroup conditions(const ReportCampaign& one) {
  const Campaign& campaign = one.campaign;
  const Identification& result = one.identification;
  RowGroup group;
  add(group, "Machine", own(campaign.robot.name));
  add(group, "Measured on", own(campaign.date));
  add(group, "Double encoders", encoderState(campaign.double_encoder));
  add(group, "Item", own(campaign.texts.item));
  add(group, "Laboratory", own(campaign.texts.laboratory));
  add(group, "Customer", own(campaign.texts.customer));
  add(group, "Operator", own(campaign.texts.operator_name));
  add(group, "Conditions", own(campaign.texts.conditions));
  add(group, "Tracker",
      campaign.tracker ? trackerWords(*campaign.tracker) : "not declared: no noise is known");
  if (one.preparation != nullptr) add(group, "Readings", withMicro(preparationWords(*one.preparation)));
  add(group, "Postures", fmt::format("{} used, {} left out", result.cases.size(), result.left_out.size()));
  add(group, "Load", result.cases.empty() ? "none was measured that could be used" : loadWords(result));
  add(group, "Own weight", result.frames.sag_note);
  if (!result.cases.empty()) add(group, "Deflection", deflectionWords(result));
  if (!result.cases.empty()) add(group, "Servo",
      result.servo_change == 0.0
          ? std::string("reported joint angles do not change under load")
          : fmt::format("reported joint angles change by at most {}° under load; not subtracted",
                        significant(result.servo_change / kDegree, 2)));
  if (result.of(Method::complete_pose).available) {
    add(group, "Characteristic length",
        fmt::format("{} m, condition number {} there", significant(result.characteristic_length.length, 3),
                    significant(result.characteristic_length.condition, 3)));
  }
  add(group, "PP's geometry", calibrationWords(result.calibration));
  return group;
}

}  // namespace

void writeConditions(Html& html, const ReportContent& content) {
  const auto section = html.element("section", {{"id", "conditions"}});
  html.leaf("h2", "Method and conditions");
  html.paragraph(
      "Displacements of the reflectors under a known load, read by a laser tracker, give the "
      "compliance of each joint by least squares. Complete Pose (CP) uses position and rotation of "
      "P_{TCP}; Partial Pose (PP) the reflectors' positions on a calibrated geometry; Decoupled "
      "Partial Pose (DPP) first joints 1 to 3 from P_{wrist}, which joints 4 to 6 do not move, "
      "then joints 4 to 6 from what is left. Stiffness is that of the closed loop, at the joint "
      "angles which the controller reports.");
  writeEach(html, content, "conditions", [&](const ReportCampaign& one) {
    writeTable(html, {"Conditions of the measurement", {"What", "As measured"}, {conditions(one)}, true, "conditions"});
  });
}

}  // namespace stiffscope::page
