#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "core/audit/checks.h"
#include "core/audit/rows.h"
#include "core/input/units.h"

namespace stiffscope {

namespace {

/// Farthest that the joint's reported angle goes while one reflector is read, rad.
double reportedTurn(const CircleSweeps& sweeps, int axis) {
  std::map<int, std::pair<double, double>> ends;  // of each reflector
  for (const CircleReading& row : sweeps.rows) {
    if (row.axis != axis) continue;
    const auto [at, added] = ends.try_emplace(row.target, row.q[axis], row.q[axis]);
    at->second = {std::min(at->second.first, row.q[axis]), std::max(at->second.second, row.q[axis])};
  }
  double turn = 0.0;
  for (const auto& [target, end] : ends) turn = std::max(turn, end.second - end.first);
  return turn;
}

/// The arc of the largest circle: one of a reflector near the axis is mostly noise.
double measuredTurn(const AxisFit& fit) {
  return std::max_element(fit.circles.begin(), fit.circles.end(),
                          [](const AxisCircle& a, const AxisCircle& b) { return a.radius < b.radius; })
      ->arc;
}

}  // namespace

Findings checkSweepAngles(const Evidence& evidence) {
  if (!evidence.campaign.circle_sweeps) return {notTestable("sweep_angles", kNoSweeps)};
  constexpr double kLimit = 2.0;
  constexpr double kWhole = 300.0 * kDegree;  // beyond, the arc's end runs into its beginning
  AuditCheck check;
  check.id = "sweep_angles";
  check.unit = "times";
  check.limit = kLimit;
  check.limit_source =
      "a joint turns by what it reports, to a thousandth; radians under degrees are 57 times off";
  for (int axis = 0; axis < 6; ++axis) {
    const MeasuredAxis& measured = evidence.frames.axes[static_cast<std::size_t>(axis)];
    if (!measured.measured || measured.fit.circles.empty()) continue;
    const double reported = reportedTurn(*evidence.campaign.circle_sweeps, axis),
                 arc = measuredTurn(measured.fit);
    if (reported > kWhole || arc > kWhole) continue;
    const double ratio = reported > 0.0 && arc > 0.0 ? std::max(arc / reported, reported / arc)
                                                     : std::numeric_limits<double>::max();
    if (check.value && ratio <= *check.value) continue;
    check.value = ratio;
    check.where = axisName(static_cast<std::size_t>(axis));
    check.message =
        fmt::format("while axis {} reports a turn of {:.4g} deg its reflectors turn by {:.4g} deg", axis + 1,
                    reported / kDegree, arc / kDegree);
  }
  if (!check.value) return {notTestable("sweep_angles", "no axis with a sweep of less than a whole turn")};
  if (*check.value <= kLimit) return {check};
  check.verdict = AuditVerdict::fail;
  check.impossible = true;
  check.message += ": angles in another unit (radians for degrees), or those of another joint";
  return {check};
}

}  // namespace stiffscope
