#include <algorithm>
#include <cmath>

#include "core/audit/chance.h"
#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/rows.h"
#include "core/audit/swept_circles.h"
#include "core/identification/identifiability.h"
#include "core/input/units.h"

namespace stiffscope {

namespace {

using namespace audit_limits;

std::string axisName(std::size_t axis) { return fmt::format("axis {}", axis + 1); }

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
  if (*check.value >= kWarnArcDeg) return check;
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

/// The reading that is farthest from its circle, in parts of its noise.
std::string worstRow(const MeasuredAxis& axis, const std::vector<SweptCircle>& circles,
                     const std::string& file) {
  double farthest = -1.0;
  std::size_t line = 0;
  for (std::size_t k = 0; k < circles.size(); ++k) {
    for (std::size_t i = 0; i < circles[k].lines.size(); ++i) {
      const Eigen::Vector3d from_axis = circles[k].readings.points[i] - axis.fit.axis.line.point;
      const double height = axis.fit.axis.line.direction.dot(from_axis);
      const double radius = (from_axis - height * axis.fit.axis.line.direction).norm();
      const double off = std::hypot(radius - axis.fit.circles[k].radius, height - axis.fit.circles[k].height);
      if (off > farthest) farthest = off, line = circles[k].lines[i];
    }
  }
  return rowName(file, line);
}

AuditCheck residualCheck(const Evidence& evidence, const std::array<std::vector<SweptCircle>, 6>& axes) {
  AuditCheck check;
  check.id = "circle_residual";
  check.unit = "of declared sd";
  check.limit_source = byChance("chi-square of each axis's residuals");
  check.value = 0.0;
  std::string beyond;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const AxisFit& fit = evidence.frames.axes[axis].fit;
    if (!fit.determined) continue;
    const double limit = chiSquareLimit(kLevel / 6.0, fit.degrees_of_freedom) / fit.degrees_of_freedom;
    if (fit.chi2_per_dof > limit) {
      beyond += fmt::format("{}axis {} by {:.1f} um rms, {:.2f} of the noise", beyond.empty() ? "" : ", ",
                            axis + 1, 1e6 * fit.rms, std::sqrt(fit.chi2_per_dof));
    }
    if (std::sqrt(fit.chi2_per_dof) <= *check.value) continue;
    check.value = std::sqrt(fit.chi2_per_dof);
    check.limit = std::sqrt(limit);
    check.where =
        fmt::format("{}, {}", axisName(axis),
                    worstRow(evidence.frames.axes[axis], axes[axis], evidence.campaign.circle_sweeps->file));
  }
  check.message = beyond.empty() ? "readings lie on their circles within the noise"
                                 : "readings leave their circles by more than noise: " + beyond +
                                       "; the stated uncertainties of the axes are widened by it";
  if (!beyond.empty()) check.verdict = AuditVerdict::warn;
  return check;
}

/// Squared difference of two lines in parts of its variance: place at the middle between the circles, and
/// direction.
double disagreement(const MeasuredLine& common, const AxisFit& a, const AxisFit& b, double height) {
  Eigen::Vector4d difference;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  const Eigen::Vector3d at = common.line.point + height * common.line.direction;
  const auto add = [&](const AxisFit& fit, double sign) {
    const Line& line = fit.axis.line;
    const double sense = line.direction.dot(common.line.direction) < 0.0 ? -1.0 : 1.0;
    const Eigen::Vector3d direction = sense * line.direction;
    const double along = (at - line.point).dot(direction);
    const Eigen::Vector3d place = line.point + along * direction;
    Eigen::Matrix2d turn;  // from the fit's own directions across to the common ones
    turn << common.across_u.dot(fit.axis.across_u), common.across_u.dot(fit.axis.across_v),
        common.across_v.dot(fit.axis.across_u), common.across_v.dot(fit.axis.across_v);
    Eigen::Matrix4d to_common = Eigen::Matrix4d::Zero();
    to_common.topLeftCorner<2, 2>() = turn;
    to_common.topRightCorner<2, 2>() = sense * along * turn;
    to_common.bottomRightCorner<2, 2>() = sense * turn;
    covariance += to_common * fit.axis.covariance * to_common.transpose();
    difference.head<2>() +=
        sign * Eigen::Vector2d(common.across_u.dot(place - at), common.across_v.dot(place - at));
    difference.tail<2>() +=
        sign * Eigen::Vector2d(common.across_u.dot(direction), common.across_v.dot(direction));
  };
  difference.setZero();
  add(a, 1.0);
  add(b, -1.0);
  return difference.dot(covariance.ldlt().solve(difference));
}

AuditCheck agreementCheck(const Evidence& evidence, const std::array<std::vector<SweptCircle>, 6>& axes) {
  AuditCheck check;
  check.id = "axis_agreement";
  check.unit = "of its sd";
  double worst = 0.0;
  int pairs = 0;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const MeasuredAxis& measured = evidence.frames.axes[axis];
    if (!measured.fit.determined) continue;
    std::vector<std::pair<std::size_t, AxisFit>> own;
    for (std::size_t k = 0; k < axes[axis].size(); ++k) {
      if (measured.fit.circles[k].radius < kReflectorRadius) continue;
      AxisFit fit = fitAxis({axes[axis][k].readings});
      if (fit.determined) own.emplace_back(k, std::move(fit));
    }
    for (std::size_t a = 0; a < own.size(); ++a) {
      for (std::size_t b = a + 1; b < own.size(); ++b) {
        ++pairs;
        const double height =
            0.5 * (measured.fit.circles[own[a].first].height + measured.fit.circles[own[b].first].height);
        const double chi2 = disagreement(measured.fit.axis, own[a].second, own[b].second, height);
        if (chi2 <= worst) continue;
        worst = chi2;
        check.where = fmt::format("{}, {} and {}", axisName(axis),
                                  targetName(evidence.campaign, axes[axis][own[a].first].target),
                                  targetName(evidence.campaign, axes[axis][own[b].first].target));
      }
    }
  }
  if (pairs == 0) return notTestable("axis_agreement", "no axis was swept with two reflectors well off it");
  const double limit = chiSquareLimit(kLevel / pairs, 4.0);
  check.value = std::sqrt(worst / 4.0);
  check.limit = std::sqrt(limit / 4.0);
  check.limit_source =
      byChance(fmt::format("chi-square of place and direction, {} pairs of reflectors", pairs));
  check.message = fmt::format(
      "reflectors that turn about one axis agree on it within {:.2f} of the difference's sd", *check.value);
  if (worst > limit) check.verdict = AuditVerdict::warn;
  return check;
}

AuditCheck onAxisCheck(const Evidence& evidence, const std::array<std::vector<SweptCircle>, 6>& axes) {
  AuditCheck check;
  check.id = "reflector_on_axis";
  check.unit = "mm";
  check.limit = 1e3 * kReflectorRadius;
  check.limit_source = "radius of a 1.5 inch reflector: nearer, the axis passes through the reflector itself";
  double least = INFINITY;
  std::string near;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const AxisFit& fit = evidence.frames.axes[axis].fit;
    if (!fit.determined) continue;
    for (std::size_t k = 0; k < axes[axis].size(); ++k) {
      const double radius = fit.circles[k].radius;
      const std::string name =
          fmt::format("{}, {}", targetName(evidence.campaign, axes[axis][k].target), axisName(axis));
      if (radius < kReflectorRadius) {
        near += fmt::format("{}{} at {:.2f} mm", near.empty() ? "" : "; ", name, 1e3 * radius);
        check.where += (check.where.empty() ? "" : "; ") + name;
      }
      least = std::min(least, radius);
    }
  }
  check.value = 1e3 * least;
  check.message =
      near.empty()
          ? "every reflector stands well off the axes"
          : "says next to nothing about the axis it stands on, nor about that joint's stiffness: " + near;
  if (!near.empty()) check.verdict = AuditVerdict::warn;
  return check;
}

}  // namespace

Findings checkCircleSweeps(const Evidence& evidence) {
  if (!evidence.campaign.circle_sweeps) {
    Findings missing;
    for (const char* id :
         {"circle_arc", "circle_count", "circle_residual", "axis_agreement", "reflector_on_axis"}) {
      missing.push_back(notTestable(id, "no circle sweeps: turn each axis by itself (`circle_sweeps`)"));
    }
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
  if (evidence.noise) {
    findings.push_back(residualCheck(evidence, axes));
  } else {
    findings.push_back(
        notTestable("circle_residual", "the tracker's noise is not declared: state `tracker`"));
  }
  findings.push_back(agreementCheck(evidence, axes));
  findings.push_back(onAxisCheck(evidence, axes));
  return findings;
}

}  // namespace stiffscope
