#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/rows.h"
#include "core/identification/identifiability.h"
#include "core/identification/partial_pose.h"

namespace stiffscope {

Findings checkPostureSet(const Evidence& evidence) {
  const LoadedArm& arm = evidence.arm;
  if (arm.cases.empty()) {
    return {notTestable("posture_set",
                        evidence.step ? "the loading's readings cannot be brought into R0: sweep axes 1 and 2"
                                      : "no loads: measure `loading`, `states` and `load_cell`")};
  }
  const std::vector<CaseEquations> equations = reflectorEquations(arm);
  const Identifiability judged =
      judgeJoints(arm.geometry, arm.cases, *evidence.campaign.load_cell, equations);
  AuditCheck check;
  check.id = "posture_set";
  check.unit = "condition";
  check.limit = audit_limits::kCondition;
  check.limit_source = "calibration practice: condition number, columns of unit length, below 100";
  std::string seen, reasons;
  bool expected_missing = false;
  for (std::size_t j = 0; j < 6; ++j) {
    const JointIdentifiability& joint = judged.joints[j];
    if (joint.identifiable) {
      seen += fmt::format("{}{}", seen.empty() ? "" : ", ", j + 1);
      continue;
    }
    reasons += fmt::format("; joint {}: {}", j + 1, joint.reason);
    // A load that hangs never turns an upright axis 1: every day with weights is like that, and is no fault.
    expected_missing |= !(j == 0 && judged.load_hangs);
  }
  if (seen.empty()) {
    check.verdict = AuditVerdict::fail;
    check.message = "no joint can be identified" + reasons;
    return {check};
  }
  check.value = partialPose(equations, judged.mask()).condition;
  check.message = fmt::format("{} postures at load step {} identify joints {}{}", arm.cases.size(),
                              *evidence.step, seen, reasons);
  if (*check.value > *check.limit || expected_missing) check.verdict = AuditVerdict::warn;
  return {check};
}

}  // namespace stiffscope
