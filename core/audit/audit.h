#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/preparation/finding.h"
#include "core/preparation/prepare.h"

namespace stiffscope::audit {

/// Is this data fit to identify from?
struct AuditReport {
  preparation::AuditVerdict verdict = preparation::AuditVerdict::pass;  ///< the worst of the checks: pass, warn or fail
  std::vector<preparation::AuditCheck> checks;
  std::vector<preparation::RejectedReading> rejected;
};

/// Audits a campaign by its readings alone. What the day did not produce makes its checks not testable, with
/// what is missing; nothing here throws for what data lacks. Limits and their sources are those of
/// core/audit/limits.h.
///
/// The checks look at the campaign that identification sees (core/preparation/prepare.h): without rejected
/// readings, the station's motion taken off where floor nests show it, so that one cause gives one finding;
/// for the same reason repeats that scatter by more than is declared replace the declared noise in the other
/// checks.
AuditReport audit(campaign::Campaign campaign);
/// Of what is prepared already; it is left as it was. Long sweeps are never copied.
AuditReport audit(preparation::PreparedCampaign& prepared);

/// Whether some check found what cannot be.
bool findsTheImpossible(const AuditReport& report);

}  // namespace stiffscope::audit
