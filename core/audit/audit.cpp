#include "core/audit/audit.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "core/audit/checks.h"

namespace stiffscope::audit {

namespace {

/// A function of the audit and the checks that it gives, by their ids; at most three.
struct Check {
  Findings (*of)(const AuditInput&);
  std::array<const char*, 3> ids;
};

/// In the order in which the day goes, which is that of the report.
constexpr std::array<Check, 17> kAllChecks{{
    {checkTimeOrder, {"time_order"}},
    {checkCompleteness, {"completeness"}},
    {checkRepeatability, {"repeatability_along", "repeatability_across"}},
    {checkRigidTool, {"rigid_tool"}},
    {checkNests, {"station_drift", "nest_moved"}},
    {checkCircleSweeps, {"circle_arc", "circle_count"}},
    {checkSweepAngles, {"sweep_angles"}},
    {checkCircleResidual, {"circle_residual"}},
    {checkSweptReflectors, {"axis_agreement", "reflector_on_axis"}},
    {checkLinkLengths, {"link_lengths"}},
    {checkWrist, {"wrist_sphere", "wrist_axes_meet"}},
    {checkUnloadedPositions, {"frame_moved", "unloaded_positions", "joint_read_back"}},
    {checkServo, {"servo_change"}},
    {checkReturnToZero, {"return_to_zero"}},
    {checkLoadCell, {"tare", "gravity_direction", "moment_lever"}},
    {checkLoadSize, {"load_size"}},
    {checkPostureSet, {"posture_set"}},
}};

/// Whether the functions give the very checks among which the chance of a false finding is shared.
constexpr bool givesAllChecks() {
  std::size_t next = preparation::kScreeningChecks;
  for (const Check& check : kAllChecks) {
    for (const char* const id : check.ids) {
      if (id == nullptr) continue;
      if (next == preparation::kAuditCheckIds.size() || preparation::kAuditCheckIds[next].id != id) return false;
      ++next;
    }
  }
  return next == preparation::kAuditCheckIds.size();
}
static_assert(givesAllChecks(), "preparation::kAuditCheckIds and kAllChecks name different checks");

preparation::AuditVerdict worst(const std::vector<preparation::AuditCheck>& checks) {
  const auto any = [&](preparation::AuditVerdict verdict) {
    return std::any_of(checks.begin(), checks.end(),
                       [&](const preparation::AuditCheck& check) { return check.verdict == verdict; });
  };
  if (any(preparation::AuditVerdict::fail)) return preparation::AuditVerdict::fail;
  return any(preparation::AuditVerdict::warn) ? preparation::AuditVerdict::warn : preparation::AuditVerdict::pass;
}

}  // namespace

AuditReport audit(campaign::Campaign campaign) {
  preparation::PreparedCampaign prepared = preparation::prepareCampaign(std::move(campaign));
  return audit(prepared);
}

AuditReport audit(preparation::PreparedCampaign& prepared) {
  AuditReport report;
  report.checks = prepared.screening;
  report.rejected = prepared.preparation.rejected;
  const std::optional<campaign::Tracker> declared = prepared.campaign.tracker;
  AuditInput input = auditInput(std::move(prepared.campaign), prepared);
  for (const Check& check : kAllChecks) {
    Findings findings = check.of(input);
    std::move(findings.begin(), findings.end(), std::back_inserter(report.checks));
  }
  report.verdict = worst(report.checks);
  prepared.campaign = std::move(input.campaign);
  prepared.campaign.tracker = declared;
  return report;
}

bool findsTheImpossible(const AuditReport& report) {
  return std::any_of(report.checks.begin(), report.checks.end(),
                     [](const preparation::AuditCheck& one) { return one.impossible; });
}

}  // namespace stiffscope::audit
