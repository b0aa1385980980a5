#include "reports/words/audit_figures.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "core/identification/warnings.h"
#include "core/io/units.h"

namespace stiffscope::reports {

namespace {

/// The unit in which a check is printed, and how figures come to it: times one, by another. One of the two is 1; times
/// 1e3 and by 1e-3 differ in the last digit.
struct PrintedUnit {
  std::string_view id, unit;
  double times = 1.0, by = 1.0;
};

/// In the order of kAuditCheckIds.
constexpr std::array kPrinted{
    PrintedUnit{"lost_beam", "readings"},
    PrintedUnit{"duplicate_readings", "readings"},
    PrintedUnit{"repeat_outliers", "readings"},
    PrintedUnit{"nest_outliers", "readings"},
    PrintedUnit{"time_order", "steps"},
    PrintedUnit{"completeness", "gaps"},
    PrintedUnit{"repeatability_along", "of declared sd"},
    PrintedUnit{"repeatability_across", "of declared sd"},
    PrintedUnit{"noise_declared", "times"},
    PrintedUnit{"rigid_tool", "sigma"},
    PrintedUnit{"station_drift", "um", 1e6},
    PrintedUnit{"nest_moved", "of noise sd"},
    PrintedUnit{"circle_arc", "deg", 1.0, io::kDegree},
    PrintedUnit{"circle_count", "readings"},
    PrintedUnit{"sweep_angles", "times"},
    PrintedUnit{"circle_residual", "of noise sd"},
    PrintedUnit{"axis_agreement", "of its sd"},
    PrintedUnit{"reflector_on_axis", "mm", 1e3},
    PrintedUnit{"link_lengths", "mm", 1.0, io::kMillimetre},
    PrintedUnit{"wrist_sphere", "of noise sd"},
    PrintedUnit{"wrist_axes_meet", "mm", 1e3},
    PrintedUnit{"rail_straight", "mm", 1.0, io::kMillimetre},
    PrintedUnit{"rail_scale", "mm/m", 1e3},
    PrintedUnit{"rail_direction", "deg", 1.0, io::kDegree},
    PrintedUnit{"frame_moved", "mm", 1e3},
    PrintedUnit{"unloaded_positions", "mm", 1e3},
    PrintedUnit{"joint_read_back", "of scatter"},
    PrintedUnit{"servo_change", "deg", 1.0, io::kDegree},
    PrintedUnit{"return_to_zero", "of noise"},
    PrintedUnit{"tare", "of its sd"},
    PrintedUnit{"gravity_direction", "mrad", 1e3},
    PrintedUnit{"moment_lever", "of its sd"},
    PrintedUnit{"load_size", "N/mm", io::kMillimetre},
    PrintedUnit{"posture_set", "condition number"},
    PrintedUnit{"arm_model", "mm", 1.0, io::kMillimetre},
    PrintedUnit{"load_model", "% left", 100.0},
    PrintedUnit{"controller_poses", "mm", 1.0, io::kMillimetre},
};

constexpr PrintedUnit kPrintedOfStations{preparation::kStationsAgree, "of noise sd"};

consteval bool printsAllChecks() {
  return std::equal(
      kPrinted.begin(), kPrinted.end(), preparation::kAuditCheckIds.begin(), preparation::kAuditCheckIds.end(),
      [](const PrintedUnit& unit, const preparation::AuditCheckId& check) { return unit.id == check.id; });
}
static_assert(printsAllChecks(), "every check needs its unit, in the order of preparation::kAuditCheckIds");

/// Checks whose figure has to reach its limit; that of a load's size is held between two, of which it has the nearer.
bool hasToReach(const preparation::AuditCheck& check) {
  constexpr std::array<std::string_view, 3> kAtLeast{"circle_arc", "circle_count", "reflector_on_axis"};
  if (check.id == "load_size") return check.limit == identification::kSoftArm;
  return std::find(kAtLeast.begin(), kAtLeast.end(), check.id) != kAtLeast.end();
}

}  // namespace

AuditFigures figuresOf(const preparation::AuditCheck& check) {
  if (!check.value && !check.limit) return {};
  const auto listed =
      std::find_if(kPrinted.begin(), kPrinted.end(), [&check](const PrintedUnit& one) { return one.id == check.id; });
  const PrintedUnit* unit = listed != kPrinted.end() ? &*listed : nullptr;
  if (check.id == kPrintedOfStations.id) unit = &kPrintedOfStations;
  if (unit == nullptr) throw std::logic_error("no unit for the check " + check.id);
  const auto printed = [unit](const std::optional<double>& figure) {
    return figure ? std::optional(*figure * unit->times / unit->by) : std::nullopt;
  };
  return {printed(check.value), printed(check.limit), std::string(unit->unit), hasToReach(check)};
}

}  // namespace stiffscope::reports
