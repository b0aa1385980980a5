#include "reports/text/identification_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/identification/coverage_factor.h"
#include "core/identification/posture_count.h"
#include "core/identification/stiffness_interval.h"
#include "core/input/units.h"
#include "reports/method_names.h"
#include "reports/text/uncertainty_text.h"
#include "reports/text/wrapped.h"

namespace stiffscope {

namespace {

using Out = std::back_insert_iterator<std::string>;

std::string stiffnessCell(const StiffnessEstimate& estimate, int joint) {
  if (!estimate.identifiable[static_cast<std::size_t>(joint)]) return "-";
  const char* mark = estimate.mark(joint).empty() ? "" : (estimate.mark(joint) == "negative" ? "!" : "?");
  const double expanded = coverageFactor(estimate, joint, kStatedCoverage) * estimate.stiffnessSd(joint) * 1e-6;
  return fmt::format("{:.4f} +-{}{}", estimate.stiffness(joint) * 1e-6,
                     std::isfinite(expanded) ? fmt::format("{:.4f}", expanded) : "?", mark);
}

void writeStiffness(const Identification& result, const std::vector<Method>& methods, Out out) {
  fmt::format_to(out, "\nStiffness, 1e6 Nm/rad, with its expanded uncertainty U (coverage 95 %, Student's t)\n  {:<5}", "");
  for (int joint = 1; joint <= 6; ++joint) fmt::format_to(out, " {:>17}", fmt::format("k{}", joint));
  fmt::format_to(out, "\n");
  bool negative = false, imprecise = false;
  for (const Method which : methods) {
    const MethodResult& method = result.of(which);
    if (!method.available) continue;
    fmt::format_to(out, "  {:<5}", namesOf(which).brief);
    for (int joint = 0; joint < 6; ++joint) {
      fmt::format_to(out, " {:>17}", stiffnessCell(method.estimate, joint));
      if (!method.estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
      negative |= method.estimate.mark(joint) == "negative";
      imprecise |= method.estimate.mark(joint) == "imprecise";
    }
    fmt::format_to(out, "\n");
  }
  fmt::format_to(out, "{}", wideIntervals(result, methods));
  if (negative) fmt::format_to(out, "  ! negative: no spring has that, something else is in the data\n");
  if (imprecise) fmt::format_to(out, "  ? imprecise: the standard uncertainty exceeds the value\n");
  for (std::size_t j = 0; j < 6; ++j) {
    const JointIdentifiability& joint = result.identifiability.joints[j];
    if (joint.identifiable || joint.reason.empty()) continue;
    fmt::format_to(out, "  {}\n", wrapped(fmt::format("k{} is not identifiable: {}", j + 1, joint.reason), 4));
  }
  for (const Method which : methods) {
    const MethodResult& method = result.of(which);
    if (method.available) continue;
    fmt::format_to(out, "  {}\n", wrapped(fmt::format("{} is unavailable: {}", namesOf(which).full, method.reason), 4));
  }
}

void writeResiduals(const Identification& result, const std::vector<Method>& methods, Out out) {
  fmt::format_to(out, "\n  {:<5}{:>12}{:>20}{:>24}\n", "", "condition", "rms residual (um)", "over dof, sigma (um)");
  for (const Method which : methods) {
    const MethodResult& method = result.of(which);
    if (!method.available) continue;
    fmt::format_to(out, "  {:<5}{:>12.2f}{:>20.1f}{:>24.1f}\n", namesOf(which).brief, method.estimate.condition,
                   method.estimate.rms_residual / kMicrometre, method.estimate.sigma / kMicrometre);
  }
  fmt::format_to(out, "  condition: condition number of the method's equations, columns of unit length; 1 at best\n");
}

void writeCompensation(const Identification& result, const std::vector<Method>& methods, Out out) {
  const auto table = [&](const char* place, const auto& member) {
    const bool any = std::any_of(methods.begin(), methods.end(), [&](Method which) {
      return result.of(which).available && (result.of(which).*member).has_value();
    });
    if (!any) return;
    fmt::format_to(out, "\nShare of the deflection compensated at {}, %\n  {:<5}{:>8}{:>10}{:>8}{:>16}\n", place, "", "used",
                   "held out", "all", "all identify");
    for (const Method which : methods) {
      const MethodResult& method = result.of(which);
      if (!method.available || !(method.*member)) continue;
      const Compensation& share = *(method.*member);
      if (method.subsets.compliances.empty()) {
        fmt::format_to(out, "  {:<5}{:>8}{:>10}{:>8}{:>16.2f}\n", namesOf(which).brief, "-", "-", "-",
                       100.0 * share.all_postures);
        continue;
      }
      fmt::format_to(out, "  {:<5}{:>8.2f}{:>10.2f}{:>8.2f}{:>16.2f}\n", namesOf(which).brief, 100.0 * share.subsets.used,
                     100.0 * share.subsets.held_out, 100.0 * share.subsets.all, 100.0 * share.all_postures);
    }
  };
  table("P_wrist (which sees joints 1-3)", &MethodResult::at_wrist);
  table("the reflectors (which see all joints)", &MethodResult::at_targets);
  for (const Method which : methods) {
    const SubsetStudy& study = result.of(which).subsets;
    if (study.compliances.empty()) continue;
    fmt::format_to(out, "  means over {} of the {} out of {} postures that identify\n",
                   study.every_subset ? fmt::format("all {} subsets", study.compliances.size())
                                      : fmt::format("{} random subsets", study.compliances.size()),
                   study.size, study.of);
    break;
  }
  if (result.noise && result.noise->at_wrist) {
    fmt::format_to(out, "  the tracker's noise alone forbids about {:.2f} % at P_wrist, {:.2f} % at the reflectors\n",
                   100.0 * std::min(1.0, *result.noise->at_wrist), 100.0 * std::min(1.0, result.noise->at_targets));
  } else if (result.noise) {
    fmt::format_to(out, "  the tracker's noise alone forbids about {:.2f} % at the reflectors\n",
                   100.0 * std::min(1.0, result.noise->at_targets));
  }
}

}  // namespace

std::string identificationText(const Campaign& campaign, const Identification& result,
                               const std::vector<Method>& methods) {
  std::string text;
  Out out(text);
  fmt::format_to(out, "{}: joint stiffness from load step{} {}, {} postures\n", campaign.name,
                 result.steps.size() > 1 ? "s" : "", fmt::join(result.steps, ", "), postureCount(result));
  for (const std::string& left_out : result.left_out) fmt::format_to(out, "  left out: {}\n", left_out);
  writeStiffness(result, methods, out);
  writeResiduals(result, methods, out);
  writeCompensation(result, methods, out);
  fmt::format_to(out, "{}", bootstrapText(result, methods));
  fmt::format_to(out, "\n");
  for (const std::string& caution : result.cautions) {
    fmt::format_to(out, "{}\n", wrapped("Caution: " + caution + ".", 2));
  }
  if (result.calibration.done) {
    fmt::format_to(out, "{}\n", wrapped(fmt::format("Partial Pose's geometry: unloaded positions missed by {:.3f} mm rms "
                                                    "before and {:.3f} mm after calibration of {} parameters.",
                                                    result.calibration.rms_before / kMillimetre,
                                                    result.calibration.rms_after / kMillimetre,
                                                    result.calibration.parameters), 0));
  }
  fmt::format_to(out, "{}\n", wrapped(fmt::format("Own weight: {}.", result.frames.sag_note), 0));
  fmt::format_to(out, "{}\n", wrapped(fmt::format("K_c is {}; it changes the joint torques by {:.2f} %.",
                                                  result.finite_deflection ? "included" : "neglected",
                                                  100.0 * result.geometric_stiffness_share), 0));
  if (result.servo_change > 0.0) {
    fmt::format_to(out, "{}\n", wrapped(fmt::format("The reported joint angles change under load by up to {:.4f} deg: "
                                                    "servo, not subtracted.", result.servo_change / kDegree), 0));
  }
  return text;
}

}  // namespace stiffscope
