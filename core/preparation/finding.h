#pragma once

#include <optional>
#include <string>
#include <vector>

namespace stiffscope::preparation {

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

/// A finding that cannot be had, with what is missing.
AuditCheck notTestable(const std::string& id, const std::string& missing);

/// Chance that a campaign without any fault gets a finding, over all checks together.
inline constexpr double kFalseFinding = 0.01;

/// Checks that share it; each divides its part again by the readings, postures or reflectors it tries
/// (Bonferroni).
inline constexpr double kChecks = 20.0;
inline constexpr double kLevel = kFalseFinding / kChecks;

/// A finding is a failure where what was found is more than twice what noise alone puts there: an interval
/// stated with k = 2 for 95 % (GUM 6.2) then covers 68 %. As a ratio of variances:
inline constexpr double kFailVarianceRatio = 4.0;

/// For limit_source.
inline std::string byChance(const std::string& statistic) {
  return statistic + "; 1 % false findings over the whole audit, shared by all that is tried";
}

}  // namespace stiffscope::preparation
