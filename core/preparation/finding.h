#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "metrology/remark.h"

namespace stiffscope::preparation {

enum class AuditVerdict { pass, warn, fail, not_testable };

/// One check of the data: the figure, the limit it is held against and where that limit comes from.
struct AuditCheck {
  std::string id;
  AuditVerdict verdict = AuditVerdict::pass;
  std::optional<double> value;  ///< SI units and radians, or a pure number; empty where the check is not testable
  std::optional<double> limit;  ///< beyond which it warns, as `value`
  Remark where;                 ///< the row where one is guilty; else the axis, posture, reflector or nest
  Remark message;               ///< what was found; what is missing where the check is not testable
  Remark limit_source;          ///< where the limit comes from
  std::vector<Remark> details;  ///< more to know: joint by joint where a check is of several
  /// No machine is like that: a unit or a table is wrong, and nothing computed from the readings means anything.
  bool impossible = false;
};

/// A reading that should not be used, and why.
struct RejectedReading {
  std::string file;  ///< as campaign.xml names it
  std::size_t line = 0;
  Remark reason;
};

/// A finding that cannot be had, with what is missing.
AuditCheck notTestable(const std::string& id, Remark missing);

/// Chance that a campaign without any fault gets a finding, over all checks together.
inline constexpr double kFalseFinding = 0.01;

/// A check by its id in reports and JSON, and in how many ways chance alone can carry it over a limit: 0 where the
/// limit is one of practice, 2 where a largest value and a sum are each held against a limit of their own.
struct AuditCheckId {
  std::string_view id;
  int limits_by_chance = 0;
  bool of_rail = false;  ///< made of an arm on a rail alone
};

/// Every check of the audit in the order of the report. They stand here and not in core/audit because the screening of
/// readings tests at the level that their number leaves to each. Screening gives the first four, core/audit/audit.cpp
/// says which function gives the others, reports/words/audit_figures.cpp in which unit its value is printed and
/// audit_plain.cpp what is amiss where it fails. A new check is one line in each; the compiler compares the four.
inline constexpr std::size_t kScreeningChecks = 4;
inline constexpr std::array<AuditCheckId, 37> kAuditCheckIds{{
    {"lost_beam"},
    {"duplicate_readings"},
    {"repeat_outliers", 1},
    {"nest_outliers", 1},
    {"time_order"},
    {"completeness"},
    {"repeatability_along", 1},
    {"repeatability_across", 1},
    {"noise_declared"},  // a factor of two, which chance does not make of thirty degrees of freedom
    {"rigid_tool", 2},   // the largest change of a distance, and the scatter of all
    {"station_drift", 1},
    {"nest_moved", 1},
    {"circle_arc"},
    {"circle_count"},
    {"sweep_angles"},
    {"circle_residual", 1},
    {"axis_agreement", 1},
    {"reflector_on_axis"},
    {"link_lengths", 1},  // five standard deviations, which is less than its share
    {"wrist_sphere", 1},
    {"wrist_axes_meet", 1},
    {"rail_straight", 0, true},
    {"rail_scale", 0, true},
    {"rail_direction", 0, true},
    {"frame_moved", 1},
    {"unloaded_positions", 1},
    {"joint_read_back", 1},
    {"servo_change"},
    {"return_to_zero", 2},  // each posture, and all together
    {"tare", 1},
    {"gravity_direction", 1},
    {"moment_lever", 1},
    {"load_size"},
    {"posture_set"},
    {"arm_model"},
    {"load_model"},
    {"controller_poses"},
}};

/// How many checks are made of a machine.
constexpr int checksOf(bool on_rail) {
  int count = 0;
  for (const AuditCheckId& check : kAuditCheckIds) count += on_rail || !check.of_rail ? 1 : 0;
  return count;
}

/// A check of days of several stations alone, beside these; a day of one is held against the same limits with it or
/// without. Its chance of a false finding is one limit's more.
inline constexpr std::string_view kStationsAgree = "stations_agree";

/// Limits that share the chance of a false finding; each divides its part again by the readings, postures or reflectors
/// it tries (Bonferroni).
constexpr int limitsByChance() {
  int limits = 0;
  for (const AuditCheckId& check : kAuditCheckIds) limits += check.limits_by_chance;
  return limits;
}

inline constexpr double kLevel = kFalseFinding / limitsByChance();

/// A finding is a failure where what was found is more than twice what noise alone puts there: an interval
/// stated with k = 2 for 95 % (GUM 6.2) then covers 68 %. As a ratio of variances:
inline constexpr double kFailVarianceRatio = 4.0;

/// For limit_source: the limit of a statistic at that level.
Remark byChance(Remark statistic);

/// For AuditCheck::where.
Remark atRow(const std::string& file, std::size_t line);

}  // namespace stiffscope::preparation
