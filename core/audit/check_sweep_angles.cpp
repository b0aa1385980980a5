#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/audit/checks.h"
#include "core/audit/rows.h"
#include "core/input/units.h"

namespace stiffscope {

namespace {

/// How far the joint's reported angle goes while a reflector is read, rad.
double reportedTurn(const CircleSweeps& sweeps, int axis, int target) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const CircleReading& row : sweeps.rows) {
    if (row.axis != axis || row.target != target) continue;
    least = std::min(least, row.q[axis]);
    most = std::max(most, row.q[axis]);
  }
  return std::max(0.0, most - least);
}

/// The largest circle: one of a reflector near the axis is mostly noise.
std::size_t largestCircle(const AxisFit& fit) {
  const auto largest =
      std::max_element(fit.circles.begin(), fit.circles.end(),
                       [](const AxisCircle& a, const AxisCircle& b) { return a.radius < b.radius; });
  return static_cast<std::size_t>(largest - fit.circles.begin());
}

AuditCheck impossible(AuditCheck check) {
  check.verdict = AuditVerdict::fail;
  check.impossible = true;
  return check;
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
    // One reflector may have been hidden over a part of the way that others were read on.
    const std::size_t largest = largestCircle(measured.fit);
    const double reported =
                     reportedTurn(*evidence.campaign.circle_sweeps, axis, measured.targets[largest]),
                 arc = measured.fit.circles[largest].arc;
    if (reported > kWhole || arc > kWhole || arc <= 0.0) continue;
    if (reported <= 0.0) {
      check.value.reset();
      check.where = axisName(static_cast<std::size_t>(axis));
      check.message = fmt::format("axis {} reports one and the same angle while its reflectors turn by {:.4g} deg",
                                  axis + 1, arc / kDegree);
      return {impossible(check)};
    }
    const double ratio = std::max(arc / reported, reported / arc);
    if (check.value && ratio <= *check.value) continue;
    check.value = ratio;
    check.where = axisName(static_cast<std::size_t>(axis));
    check.message =
        fmt::format("while axis {} reports a turn of {:.4g} deg its reflectors turn by {:.4g} deg", axis + 1,
                    reported / kDegree, arc / kDegree);
  }
  if (!check.value) return {notTestable("sweep_angles", "no axis with a sweep of less than a whole turn")};
  if (*check.value <= kLimit) return {check};
  check.message += ": angles in another unit (radians for degrees), or those of another joint";
  return {impossible(check)};
}

}  // namespace stiffscope
