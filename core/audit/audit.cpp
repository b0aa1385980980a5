#include "core/audit/audit.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "core/audit/checks.h"

namespace stiffscope::audit {

namespace {

using Check = Findings (*)(const Evidence&);

/// In the order in which the day goes, which is that of the report.
constexpr std::array<Check, 17> kAllChecks{
    checkTimeOrder,    checkCompleteness,      checkRepeatability,  checkRigidTool,       checkNests,
    checkCircleSweeps, checkSweepAngles,       checkCircleResidual, checkSweptReflectors, checkLinkLengths,
    checkWrist,        checkUnloadedPositions, checkServo,          checkReturnToZero,    checkLoadCell,
    checkLoadSize,     checkPostureSet};

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
  Evidence evidence = gatherEvidence(std::move(prepared.campaign), prepared);
  for (const Check check : kAllChecks) {
    Findings findings = check(evidence);
    std::move(findings.begin(), findings.end(), std::back_inserter(report.checks));
  }
  report.verdict = worst(report.checks);
  prepared.campaign = std::move(evidence.campaign);
  prepared.campaign.tracker = declared;
  return report;
}

bool findsTheImpossible(const AuditReport& report) {
  return std::any_of(report.checks.begin(), report.checks.end(),
                     [](const preparation::AuditCheck& one) { return one.impossible; });
}

}  // namespace stiffscope::audit
