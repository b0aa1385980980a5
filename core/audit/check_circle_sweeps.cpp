#include <algorithm>
#include <cmath>

#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/rows.h"
#include "core/audit/swept_circles.h"
#include "core/identification/identifiability.h"
#include "core/input/units.h"

namespace stiffscope {

namespace {

using namespace audit_limits;

/// The circle that says most about its axis.
const AxisCircle& widest(const AxisFit& fit) {
  return *std::max_element(fit.circles.begin(), fit.circles.end(),
                           [](const AxisCircle& a, const AxisCircle& b) { return a.radius < b.radius; });
}

/// Farthest that any swept reflector stands from the axis it turns about: the reach over which a tilt works.
double reachOf(const std::array<MeasuredAxis, 6>& axes) {
  double reach = 0.0;
  for (const MeasuredAxis& axis : axes) {
    if (axis.fit.determined) reach = std::max(reach, widest(axis.fit).radius);
  }
  return reach;
}

AuditCheck arcCheck(const MeasuredAxis& axis, std::size_t number, double reach, int readings) {
  const AxisUncertainty uncertainty = uncertaintyOf(axis.fit);
  const double arc = widest(axis.fit).arc;
  const double at_reach = std::hypot(reach * uncertainty.direction, uncertainty.place);
  const double tolerance = kShareOfTolerance * TrustLimits().position;
  AuditCheck check;
  check.id = "circle_arc";
  check.value = arc / kDegree;
  check.limit = kWarnArcDeg;
  check.unit = "deg";
  check.where = axisName(number);
  check.limit_source = fmt::format(
      "circle-point practice: warn below {:.0f} deg, fail below {:.0f} deg, unless the axis is "
      "still known at the arm's reach to {:.0f} um, a third of the {:.1f} mm to which "
      "identification trusts places",
      kWarnArcDeg, kFailArcDeg, 1e6 * tolerance, 1e3 * TrustLimits().position);
  check.message = fmt::format(
      "{}: arc of {:.1f} deg; known to {:.1f} urad in direction and {:.1f} um in place (one sigma), "
      "{:.0f} um at the reach of {:.2f} m",
      axisName(number), *check.value, 1e6 * uncertainty.direction, 1e6 * uncertainty.place, 1e6 * at_reach,
      reach);
  if (*check.value >= kWarnArcDeg) {
    // Residuals widen the stated uncertainty; they are circle_residual's to name.
    if (at_reach <= tolerance * std::max(1.0, std::sqrt(axis.fit.chi2_per_dof))) return check;
    check.verdict = AuditVerdict::warn;
    check.message +=
        "; does not suffice for identification, wide as it is: take more readings, or reflectors farther "
        "from the axis and along it";
    return check;
  }
  const bool enough = at_reach <= tolerance;
  check.message +=
      fmt::format(", {:.1f} times what as many readings over {:.0f} deg would give; {} for identification",
                  arcCost(arc, readings), kWarnArcDeg, enough ? "still suffices" : "does not suffice");
  const bool short_arc = *check.value < kFailArcDeg;
  if (short_arc) check.verdict = enough ? AuditVerdict::warn : AuditVerdict::fail;
  if (!short_arc && !enough) check.verdict = AuditVerdict::warn;
  return check;
}

AuditCheck countCheck(const std::array<std::vector<SweptCircle>, 6>& axes, const std::string& file) {
  AuditCheck check;
  check.id = "circle_count";
  check.unit = "readings";
  check.limit = kLeastCircleReadings;
  check.limit_source = "three readings make a circle, twice as many leave as many again to check it by";
  std::size_t least = SIZE_MAX;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    for (const SweptCircle& circle : axes[axis]) {
      if (circle.lines.size() >= least) continue;
      least = circle.lines.size();
      check.where = fmt::format("{}, {}", axisName(axis), rowName(file, circle.lines.front()));
    }
  }
  check.value = static_cast<double>(least);
  check.message = fmt::format("the smallest circle has {} readings", least);
  if (*check.value < *check.limit) check.verdict = AuditVerdict::warn;
  return check;
}

}  // namespace

Findings checkCircleSweeps(const Evidence& evidence) {
  if (!evidence.campaign.circle_sweeps) {
    Findings missing;
    for (const char* id : {"circle_arc", "circle_count"}) missing.push_back(notTestable(id, kNoSweeps));
    return missing;
  }
  const auto axes = sweptCircles(evidence);
  const double reach = reachOf(evidence.frames.axes);
  Findings findings;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const MeasuredAxis& measured = evidence.frames.axes[axis];
    if (measured.fit.determined) {
      findings.push_back(arcCheck(measured, axis, reach, static_cast<int>(axes[axis].front().lines.size())));
    } else {
      findings.push_back(notTestable("circle_arc", fmt::format("axis {}: {}", axis + 1, measured.reason)));
      findings.back().where = axisName(axis);
    }
  }
  findings.push_back(countCheck(axes, evidence.campaign.circle_sweeps->file));
  return findings;
}

}  // namespace stiffscope
