#include "core/audit/check_design.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>

#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/campaign/row_names.h"
#include "core/identification/identifiability.h"
#include "core/identification/load_case.h"
#include "core/identification/partial_pose.h"

namespace stiffscope::audit {

namespace {

/// "joint 2: identifiable: turned by 812 Nm rms, known to 3.1 Nm", or why not.
std::string described(std::size_t joint, const identification::JointIdentifiability& judged) {
  if (!judged.identifiable) return fmt::format("joint {}: not identifiable: {}", joint + 1, judged.reason);
  return fmt::format("joint {}: identifiable: the load turns it by {:.4g} Nm rms, known to {:.2g} Nm", joint + 1,
                     judged.trusted_rms, judged.uncertainty_rms);
}

/// A day of sweeps alone has nothing to test here; one that was loaded, and of which no load is of use, fails.
preparation::AuditCheck withoutCases(const AuditInput& input) {
  const campaign::Campaign& campaign = input.campaign;
  const bool measured = campaign.loading || campaign.displacements;
  if (!measured)
    return preparation::notTestable("posture_set", "no loads: measure `loading`, `states` and `load_cell`");
  const std::string lacking = identification::whatLoadsLack(campaign);
  if (lacking.empty() && input.step && !input.frames.arm.points_placed) {
    return preparation::notTestable("posture_set",
                                    "the loading's readings cannot be brought into R0: sweep axes 1 and 2");
  }
  preparation::AuditCheck check;
  check.id = "posture_set";
  check.verdict = preparation::AuditVerdict::fail;
  check.message = !lacking.empty() ? lacking
                  : !input.step    ? "no load step has a force"
                                : "no posture has readings at the heaviest load step and, of absolute points, unloaded "
                                  "ones (step 0): nothing to identify from";
  return check;
}

}  // namespace

Findings checkPostureSet(const AuditInput& input) {
  const identification::LoadedArm& arm = input.arm;
  if (arm.cases.empty()) {
    return {withoutCases(input)};
  }
  const std::vector<identification::CaseEquations> equations = identification::reflectorEquations(arm);
  const identification::Identifiability judged =
      identification::evaluateIdentifiability(arm.geometry, arm.cases, *input.campaign.load_cell, equations);
  preparation::AuditCheck check;
  check.id = "posture_set";
  check.unit = "condition number";
  check.limit = kCondition;
  check.limit_source = "calibration practice: condition number, columns of unit length, below 100";
  std::vector<std::string> seen, reasons;
  bool expected_missing = false;
  for (std::size_t j = 0; j < 6; ++j) {
    const identification::JointIdentifiability& joint = judged.joints[j];
    check.details.push_back(described(j, joint));
    if (joint.identifiable) {
      seen.push_back(std::to_string(j + 1));
      continue;
    }
    reasons.push_back(fmt::format("joint {}: {}", j + 1, joint.reason));
    // A load that hangs never turns an upright axis 1: every day with weights is like that, and is no fault.
    expected_missing |= !(j == 0 && judged.load_hangs);
  }
  const std::string why = reasons.empty() ? "" : fmt::format("; {}", fmt::join(reasons, "; "));
  if (seen.empty()) {
    check.verdict = preparation::AuditVerdict::fail;
    check.message = "no joint can be identified" + why;
    return {check};
  }
  check.value = identification::partialPose(equations, judged.mask()).condition;
  check.message = fmt::format(
      "{} postures at load step {} identify joints {} with a condition number of {:.3g} of their equations{}",
      arm.cases.size(), *input.step, fmt::join(seen, ", "), *check.value, why);
  if (*check.value > *check.limit || expected_missing) check.verdict = preparation::AuditVerdict::warn;
  return {check};
}

namespace {

std::string joined(const std::vector<effects::Effect>& effects, const char* between) {
  std::string text;
  for (const effects::Effect effect : effects)
    text += (text.empty() ? "" : between) + std::string(effects::idOf(effect));
  return text;
}

}  // namespace

void addSeparableEffects(const diagnosis::Diagnosis& diagnosis, AuditReport& report) {
  const auto check = std::find_if(report.checks.begin(), report.checks.end(),
                                  [](const preparation::AuditCheck& one) { return one.id == "posture_set"; });
  if (check == report.checks.end() || !diagnosis.usable) return;
  std::array<bool, effects::kEffectCount> apart;
  apart.fill(true);
  std::vector<effects::Effect> untestable;
  for (const diagnosis::NotTestable& one : diagnosis.not_testable) {
    apart[static_cast<std::size_t>(one.effect)] = false;
    untestable.push_back(one.effect);
  }
  for (const auto& group : diagnosis.aliases) {
    for (const effects::Effect effect : group) apart[static_cast<std::size_t>(effect)] = false;
  }
  std::vector<effects::Effect> told;
  for (std::size_t i = 0; i < effects::kEffectCount; ++i) {
    if (apart[i]) told.push_back(static_cast<effects::Effect>(i));
  }
  if (!told.empty()) check->details.push_back("effects that could be told apart: " + joined(told, ", "));
  for (const auto& group : diagnosis.aliases) {
    check->details.push_back("effects that could not always be told apart: " + joined(group, " or "));
  }
  if (!untestable.empty()) {
    check->details.push_back("effects that cannot be tested here (diagnose says what is missing): " +
                             joined(untestable, ", "));
  }
}

}  // namespace stiffscope::audit
