#include "core/audit/check_design.h"

#include <algorithm>
#include <array>

#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/remarks.h"
#include "core/effects/all.h"
#include "core/identification/identifiability.h"
#include "core/identification/load_case.h"
#include "core/identification/partial_pose.h"
#include "core/identification/remarks.h"

namespace stiffscope::audit {

namespace {

Remark described(std::size_t joint, const identification::JointIdentifiability& judged) {
  if (!judged.identifiable) return Remark(RemarkId::joint_not_identifiable, joint + 1, judged.reason);
  return Remark(RemarkId::joint_identifiable, joint + 1, judged.trusted_rms, judged.uncertainty_rms);
}

bool everLoaded(const campaign::Campaign& campaign) {
  const auto anyStep = [](const auto& table) {
    return table && std::any_of(table->rows.begin(), table->rows.end(), [](const auto& row) { return row.step != 0; });
  };
  return anyStep(campaign.states) || anyStep(campaign.loading) || anyStep(campaign.displacements);
}

/// A day without a load has nothing to test here; one that was loaded, and of which no load is of use, fails.
preparation::AuditCheck withoutCases(const AuditInput& input) {
  const campaign::Campaign& campaign = input.campaign;
  if (!everLoaded(campaign)) return preparation::notTestable("posture_set", Remark(MissingId::no_loads));
  const Remark lacking = identification::whatLoadsLack(campaign);
  if (lacking.empty() && input.step && input.not_calibrated.empty() && !input.frames.arm.points_placed) {
    return preparation::notTestable("posture_set", Remark(MissingId::loading_not_in_r0));
  }
  preparation::AuditCheck check;
  check.id = "posture_set";
  check.verdict = preparation::AuditVerdict::fail;
  check.message = !lacking.empty() ? lacking
                  : !input.not_calibrated.empty()
                      ? Remark(identification::RemarkId::geometry_not_calibrated, input.not_calibrated)
                  : !input.step ? Remark(MissingId::no_step_with_force)
                                : Remark(MissingId::no_posture_to_identify_from);
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
  check.limit = kCondition;
  check.limit_source = Remark(LimitId::condition_practice);
  std::vector<std::size_t> seen;
  std::vector<Remark> missing;
  bool expected_missing = false;
  for (std::size_t j = 0; j < judged.joints.size(); ++j) {
    const identification::JointIdentifiability& joint = judged.joints[j];
    check.details.push_back(described(j, joint));
    if (joint.identifiable) {
      seen.push_back(j + 1);
      continue;
    }
    missing.push_back(Remark(RemarkId::joint_missing, j + 1, joint.reason));
    // A load that hangs never turns an upright axis 1: every day with weights is like that, and is no fault.
    expected_missing |= !(j == 0 && judged.load_hangs);
  }
  if (seen.empty()) {
    check.verdict = preparation::AuditVerdict::fail;
    check.message = Remark(RemarkId::no_joint_identified, missing);
    return {check};
  }
  check.value = identification::partialPose(equations, judged.mask()).condition;
  check.message =
      Remark(RemarkId::joints_identified, arm.cases.size(), *input.step, seen, *check.value, std::move(missing));
  if (*check.value > *check.limit || expected_missing) check.verdict = preparation::AuditVerdict::warn;
  return {check};
}

namespace {

std::vector<std::string> idsOf(const std::vector<effects::Effect>& effects) {
  std::vector<std::string> ids;
  for (const effects::Effect effect : effects) ids.emplace_back(effects::idOf(effect));
  return ids;
}

}  // namespace

void addSeparableEffects(const diagnosis::Diagnosis& diagnosis, bool on_rail, AuditReport& report) {
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
    const auto effect = static_cast<effects::Effect>(i);
    if (apart[i] && effects::concerns(effect, on_rail)) told.push_back(effect);
  }
  if (!told.empty()) check->details.push_back(Remark(RemarkId::effects_apart, idsOf(told)));
  for (const auto& group : diagnosis.aliases) {
    check->details.push_back(Remark(RemarkId::effects_alike, idsOf(group)));
  }
  if (!untestable.empty()) {
    check->details.push_back(Remark(RemarkId::effects_not_testable, idsOf(untestable)));
  }
}

}  // namespace stiffscope::audit
