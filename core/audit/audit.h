#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope {

struct PreparedCampaign;

enum class AuditVerdict { pass, warn, fail, not_testable };

/// One check of the data: the figure, the limit it is held against and where that limit comes from.
struct AuditCheck {
  std::string id;
  AuditVerdict verdict = AuditVerdict::pass;
  std::optional<double> value;  ///< in `unit`; empty where the check is not testable
  std::optional<double> limit;  ///< beyond which it warns, in `unit`
  std::string unit;
  std::string where;         ///< `FILE:LINE` where a row is guilty; else the axis, posture, reflector or nest
  std::string message;       ///< what was found; what is missing where the check is not testable
  std::string limit_source;  ///< where the limit comes from, in words
  std::vector<std::string>
      details;  ///< more to know, a sentence each: joint by joint where a check is of several
  /// No machine is like that: a unit or a table is wrong, and nothing computed from the readings means anything.
  bool impossible = false;
};

/// A reading that should not be used, and why.
struct RejectedReading {
  std::string file;  ///< as campaign.xml names it
  std::size_t line = 0;
  std::string reason;
};

/// Is this data fit to identify from?
struct AuditReport {
  AuditVerdict verdict = AuditVerdict::pass;  ///< the worst of the checks: pass, warn or fail
  std::vector<AuditCheck> checks;
  std::vector<RejectedReading> rejected;
};

/// Audits a campaign by its readings alone. What the day did not produce makes its checks not testable, with
/// what is missing; nothing here throws for what data lacks. Limits and their sources are those of
/// core/audit/limits.h.
///
/// The checks look at the campaign that identification sees (core/audit/prepare.h): without rejected
/// readings, the station's motion taken off where floor nests show it, so that one cause gives one finding;
/// for the same reason repeats that scatter by more than is declared replace the declared noise in the other
/// checks.
AuditReport audit(Campaign campaign);
/// Of what is prepared already; it is left as it was. Long sweeps are never copied.
AuditReport audit(PreparedCampaign& prepared);

/// Whether some check found what cannot be.
bool findsTheImpossible(const AuditReport& report);

}  // namespace stiffscope
