#include "core/audit/checks.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/audit/limits.h"
#include "core/audit/remarks.h"
#include "core/audit/sag_doubt.h"
#include "core/campaign/row_names.h"
#include "core/identification/identifiability.h"
#include "core/identification/warnings.h"
#include "core/io/units.h"
#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::audit {

namespace {

/// A reading against its circle: away from the axis, and along it.
struct OffCircle {
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
  double radial = 0.0, along = 0.0;  ///< m
};

OffCircle offCircle(const metrology::AxisFit& fit, std::size_t circle, const Eigen::Vector3d& point) {
  const Eigen::Vector3d from_axis = point - fit.axis.line.point;
  const double height = fit.axis.line.direction.dot(from_axis);
  const Eigen::Vector3d across = from_axis - height * fit.axis.line.direction;
  const double radius = across.norm();
  return {across / radius, radius - fit.circles[circle].radius, height - fit.circles[circle].height};
}

/// How an axis's readings lie off their circles, in parts of the noise: two numbers a reading. `up`: the sense in which
/// the axis points.
Eigen::VectorXd offCircles(const metrology::AxisFit& fit, const std::vector<SweptCircle>& circles,
                           const Eigen::Vector3d& up) {
  const Eigen::Vector3d direction =
      fit.axis.line.direction.dot(up) < 0.0 ? -fit.axis.line.direction : fit.axis.line.direction;
  std::vector<double> all;
  for (std::size_t k = 0; k < circles.size(); ++k) {
    for (std::size_t i = 0; i < circles[k].lines.size(); ++i) {
      const OffCircle off = offCircle(fit, k, circles[k].readings.points[i]);
      Eigen::Matrix<double, 2, 3> seen;
      seen << off.outward.transpose(), direction.transpose();
      const Eigen::Matrix2d covariance = seen * circles[k].readings.covariances[i] * seen.transpose();
      const Eigen::Vector2d left(off.radial, direction.dot(fit.axis.line.direction) < 0.0 ? -off.along : off.along);
      const Eigen::Vector2d in_noise = covariance.llt().matrixL().solve(left);
      all.insert(all.end(), {in_noise[0], in_noise[1]});
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

/// chi2 of the circles that each axis's readings are left with once the sag that was taken off them has its doubt.
class CirclesInDoubt {
 public:
  CirclesInDoubt(const AuditInput& input, const SweptCircles& circles) : input_(input), circles_(circles) {
    for (const AuditInput& other : underOtherSags(input)) {
      others_.push_back({other.frames.axes, sweptCircles(other)});
    }
  }

  double left(std::size_t axis) const {
    const metrology::AxisFit& fit = input_.frames.axes[axis].fit;
    const Eigen::Vector3d up = fit.axis.line.direction;
    std::vector<Eigen::VectorXd> moved;
    for (const auto& [axes, circles] : others_) {
      if (axes[axis].fit.determined) moved.push_back(offCircles(axes[axis].fit, circles[axis], up));
    }
    return fit.chi2_per_dof * fit.degrees_of_freedom - explainedBySag(offCircles(fit, circles_[axis], up), moved);
  }

 private:
  const AuditInput& input_;
  const SweptCircles& circles_;
  std::vector<std::pair<frames::MeasuredAxes, SweptCircles>> others_;
};

/// The reading that is farthest from its circle.
struct WorstReading {
  std::size_t line = 0;
  double share = 0.0;  ///< of the sum of squared distances from the circles
};

WorstReading worstReading(const frames::MeasuredAxis& axis, const std::vector<SweptCircle>& circles) {
  WorstReading worst;
  double farthest = -1.0, sum = 0.0;
  for (std::size_t k = 0; k < circles.size(); ++k) {
    for (std::size_t i = 0; i < circles[k].lines.size(); ++i) {
      const OffCircle parts = offCircle(axis.fit, k, circles[k].readings.points[i]);
      const double off = std::hypot(parts.radial, parts.along);
      sum += off * off;
      if (off > farthest) farthest = off, worst.line = circles[k].lines[i];
    }
  }
  worst.share = sum > 0.0 ? farthest * farthest / sum : 0.0;
  return worst;
}

/// What the misfits look like: one reading, or the axis moving as it turns.
class Causes {
 public:
  void add(std::size_t axis, const WorstReading& worst, const std::string& row) {
    if (worst.share > kExplains) {
      causes_.push_back(Remark(RemarkId::one_reading_off, axis + 1, row));
    } else {
      running_.push_back(axis + 1);
    }
  }

  std::vector<Remark> all() const {
    std::vector<Remark> all = causes_;
    if (!running_.empty()) all.push_back(Remark(RemarkId::runs_along_sweep, running_));
    return all;
  }

 private:
  std::vector<Remark> causes_;
  std::vector<std::size_t> running_;
};

preparation::AuditCheck residualCheck(const AuditInput& input, const SweptCircles& axes) {
  preparation::AuditCheck check;
  check.id = "circle_residual";
  check.limit_source = preparation::byChance(Remark(LimitId::chi_square_of_axes));
  check.value = 0.0;
  std::vector<Remark> beyond;
  Causes causes;
  std::optional<CirclesInDoubt> in_doubt;  // asked only where noise alone does not do
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const frames::MeasuredAxis& measured = input.frames.axes[axis];
    const metrology::AxisFit& fit = measured.fit;
    if (!fit.determined) continue;
    const double limit =
        numerics::chiSquareLimit(preparation::kLevel / static_cast<double>(axes.size()), fit.degrees_of_freedom) /
        fit.degrees_of_freedom;
    double chi2_per_dof = fit.chi2_per_dof;
    if (chi2_per_dof > limit) {
      if (!in_doubt) in_doubt.emplace(input, axes);
      chi2_per_dof = in_doubt->left(axis) / fit.degrees_of_freedom;
    }
    const double ratio = std::sqrt(chi2_per_dof);
    const WorstReading worst = worstReading(measured, axes[axis]);
    const std::string row = campaign::rowName(input.campaign.circle_sweeps->file, worst.line);
    if (chi2_per_dof > limit) {
      beyond.push_back(Remark(RemarkId::axis_off_circles, axis + 1, fit.rms, ratio));
      causes.add(axis, worst, row);
    }
    if (ratio <= *check.value) continue;
    check.value = ratio;
    check.limit = std::sqrt(limit);
    check.where = Remark(RemarkId::at_axis_row, axis + 1, row);
  }
  check.message = Remark(RemarkId::on_circles);
  if (beyond.empty()) return check;
  check.verdict = preparation::AuditVerdict::warn;
  check.message = Remark(RemarkId::off_circles, std::move(beyond), causes.all());
  return check;
}

}  // namespace

Remark noCircles(const frames::MeasuredAxes& axes) {
  const bool any = std::any_of(axes.begin(), axes.end(), [](const auto& axis) { return axis.fit.determined; });
  return any ? Remark() : Remark(MissingId::axis_not_measured, 1, axes.front().reason);
}

Findings checkCircleResidual(const AuditInput& input) {
  if (!input.campaign.circle_sweeps) return {preparation::notTestable("circle_residual", Remark(MissingId::no_sweeps))};
  if (!input.noise) {
    return {preparation::notTestable("circle_residual", Remark(MissingId::tracker_not_declared))};
  }
  const Remark none = noCircles(input.frames.axes);
  if (!none.empty()) return {preparation::notTestable("circle_residual", none)};
  return {residualCheck(input, sweptCircles(input))};
}

namespace {

/// The largest circle: one of a reflector near the axis is mostly noise.
std::size_t largestCircle(const metrology::AxisFit& fit) {
  const auto largest = std::max_element(
      fit.circles.begin(), fit.circles.end(),
      [](const metrology::AxisCircle& a, const metrology::AxisCircle& b) { return a.radius < b.radius; });
  return static_cast<std::size_t>(largest - fit.circles.begin());
}

/// The circle over which the axis was seen to turn farthest: a reflector may be hidden over a part of the way.
std::size_t widestCircle(const metrology::AxisFit& fit) {
  std::size_t widest = largestCircle(fit);
  for (std::size_t k = 0; k < fit.circles.size(); ++k) {
    if (fit.circles[k].radius >= kReflectorRadius && fit.circles[k].arc > fit.circles[widest].arc) widest = k;
  }
  return widest;
}

/// Farthest that any swept reflector stands from the axis it turns about: the reach over which a tilt works.
double reachOf(const frames::MeasuredAxes& axes) {
  double reach = 0.0;
  for (const frames::MeasuredAxis& axis : axes) {
    if (axis.fit.determined) reach = std::max(reach, axis.fit.circles[largestCircle(axis.fit)].radius);
  }
  return reach;
}

preparation::AuditCheck arcCheck(const frames::MeasuredAxis& axis, const std::vector<SweptCircle>& circles,
                                 std::size_t number, double reach) {
  const AxisUncertainty uncertainty = uncertaintyOf(axis.fit);
  const std::size_t widest = widestCircle(axis.fit);
  const double arc = axis.fit.circles[widest].arc;
  const int readings = static_cast<int>(circles[widest].lines.size());
  const double at_reach = std::hypot(reach * uncertainty.direction, uncertainty.place);
  const double tolerance = kShareOfTolerance * identification::TrustLimits().position;
  preparation::AuditCheck check;
  check.id = "circle_arc";
  check.value = arc;
  check.limit = kWarnArc;
  check.where = Remark(RemarkId::at_axis, number + 1);
  check.limit_source =
      Remark(LimitId::arc_practice, kWarnArc, kFailArc, tolerance, identification::TrustLimits().position);
  const auto says = [&](std::vector<Remark> more) {
    return Remark(RemarkId::arc_known, number + 1, arc, uncertainty.direction, uncertainty.place, at_reach, reach,
                  std::move(more));
  };
  if (arc >= kWarnArc) {
    check.message = says({});
    // Residuals widen the stated uncertainty; they are circle_residual's to name.
    if (at_reach <= tolerance * std::max(1.0, std::sqrt(axis.fit.chi2_per_dof))) return check;
    check.verdict = preparation::AuditVerdict::warn;
    check.message = says({Remark(RemarkId::wide_not_enough)});
    return check;
  }
  const bool enough = at_reach <= tolerance;
  check.message = says({Remark(RemarkId::short_arc, arcCost(arc, readings), kWarnArc, enough)});
  const bool short_arc = arc < kFailArc;
  if (short_arc) check.verdict = enough ? preparation::AuditVerdict::warn : preparation::AuditVerdict::fail;
  if (!short_arc && !enough) check.verdict = preparation::AuditVerdict::warn;
  return check;
}

preparation::AuditCheck countCheck(const SweptCircles& axes, const std::string& file) {
  preparation::AuditCheck check;
  check.id = "circle_count";
  check.limit = kLeastCircleReadings;
  check.limit_source = Remark(LimitId::circle_redundancy);
  std::size_t least = SIZE_MAX;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    for (const SweptCircle& circle : axes[axis]) {
      if (circle.lines.size() >= least) continue;
      least = circle.lines.size();
      check.where = Remark(RemarkId::at_axis_row, axis + 1, campaign::rowName(file, circle.lines.front()));
    }
  }
  check.value = static_cast<double>(least);
  check.message = Remark(RemarkId::smallest_circle, least);
  if (*check.value < *check.limit) check.verdict = preparation::AuditVerdict::warn;
  return check;
}

}  // namespace

Findings checkCircleSweeps(const AuditInput& input) {
  if (!input.campaign.circle_sweeps) {
    Findings missing;
    for (const char* id : {"circle_arc", "circle_count"})
      missing.push_back(preparation::notTestable(id, Remark(MissingId::no_sweeps)));
    return missing;
  }
  const auto axes = sweptCircles(input);
  const double reach = reachOf(input.frames.axes);
  Findings findings;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const frames::MeasuredAxis& measured = input.frames.axes[axis];
    if (measured.fit.determined) {
      findings.push_back(arcCheck(measured, axes[axis], axis, reach));
    } else {
      findings.push_back(
          preparation::notTestable("circle_arc", Remark(MissingId::axis_not_measured, axis + 1, measured.reason)));
      findings.back().where = Remark(RemarkId::at_axis, axis + 1);
    }
  }
  findings.push_back(countCheck(axes, input.campaign.circle_sweeps->file));
  return findings;
}

Findings checkLinkLengths(const AuditInput& input) {
  preparation::AuditCheck check;
  check.id = "link_lengths";
  double farthest = -1.0;
  std::size_t at = 0;
  const auto& links = input.frames.links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!links[i].distance_sd) continue;
    const double off = std::abs(links[i].distance - links[i].nominal_distance);
    if (off > farthest) farthest = off, at = i;
  }
  if (farthest < 0.0) return {preparation::notTestable("link_lengths", Remark(MissingId::no_neighbouring_axes))};
  const frames::LinkGeometry& link = links[at];
  check.value = farthest;
  // A short arc may leave a distance open by more than machines differ.
  constexpr double kByChance = 5.0;
  check.limit = std::max(identification::kMissedGeometry, kByChance * *link.distance_sd);
  check.limit_source = Remark(LimitId::built_to_drawing);
  check.where = Remark(RemarkId::at_axes, at + 1, at + 2);
  check.impossible = *check.value > *check.limit;
  if (check.impossible) check.verdict = preparation::AuditVerdict::fail;
  check.message = Remark(RemarkId::axes_apart, at + 1, at + 2, link.distance, link.nominal_distance, check.impossible);
  return {check};
}

namespace {

/// How far the joint's reported angle goes while a reflector is read, rad.
double reportedTurn(const campaign::CircleSweeps& sweeps, int axis, int target) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const campaign::CircleReading& row : sweeps.rows) {
    if (row.axis != axis || row.target != target) continue;
    least = std::min(least, row.q[axis]);
    most = std::max(most, row.q[axis]);
  }
  return std::max(0.0, most - least);
}

preparation::AuditCheck impossible(preparation::AuditCheck check) {
  check.verdict = preparation::AuditVerdict::fail;
  check.impossible = true;
  return check;
}

}  // namespace

Findings checkSweepAngles(const AuditInput& input) {
  if (!input.campaign.circle_sweeps) return {preparation::notTestable("sweep_angles", Remark(MissingId::no_sweeps))};
  constexpr double kLimit = 2.0;
  constexpr double kWhole = 300.0 * io::kDegree;  // beyond, the arc's end runs into its beginning
  preparation::AuditCheck check;
  check.id = "sweep_angles";
  check.limit = kLimit;
  check.limit_source = Remark(LimitId::turns_as_reported);
  for (int axis = 0; axis < input.campaign.robot.joints(); ++axis) {
    const frames::MeasuredAxis& measured = input.frames.axes[static_cast<std::size_t>(axis)];
    if (!measured.measured || measured.fit.circles.empty()) continue;
    // One reflector may have been hidden over a part of the way that others were read on.
    const std::size_t largest = largestCircle(measured.fit);
    const double reported = reportedTurn(*input.campaign.circle_sweeps, axis, measured.targets[largest]),
                 arc = measured.fit.circles[largest].arc;
    if (reported > kWhole || arc > kWhole || arc <= 0.0) continue;
    if (reported <= 0.0) {
      check.value.reset();
      check.where = Remark(RemarkId::at_axis, axis + 1);
      check.message = Remark(RemarkId::angle_stays, axis + 1, arc);
      return {impossible(check)};
    }
    const double ratio = std::max(arc / reported, reported / arc);
    if (check.value && ratio <= *check.value) continue;
    check.value = ratio;
    check.where = Remark(RemarkId::at_axis, axis + 1);
    check.message = Remark(RemarkId::angle_and_turn, axis + 1, reported, arc, ratio > kLimit);
  }
  if (!check.value) return {preparation::notTestable("sweep_angles", Remark(MissingId::no_sweep_below_whole_turn))};
  if (*check.value <= kLimit) return {check};
  return {impossible(check)};
}

namespace {

/// Larger standard deviation of (cos, sin) coefficients, the constant to be found too, noise one.
double largestSd(double arc, int readings) {
  Eigen::MatrixXd design(readings, 3);
  for (int i = 0; i < readings; ++i) {
    const double at = arc * (static_cast<double>(i) / (readings - 1) - 0.5);
    design.row(i) << std::cos(at), std::sin(at), 1.0;
  }
  const Eigen::Matrix3d normal = design.transpose() * design;
  const Eigen::Matrix3d covariance = normal.inverse();
  return std::sqrt(symmetricEigenvalues(covariance.topLeftCorner<2, 2>())[1]);
}

}  // namespace

SweptCircles sweptCircles(const AuditInput& input) {
  SweptCircles axes(input.campaign.robot.axes_in_base_at_zero.size());
  if (!input.campaign.circle_sweeps) return axes;
  const auto& rows = input.campaign.circle_sweeps->rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<SweptCircle>& circles = axes[static_cast<std::size_t>(rows[i].axis)];
    auto circle = std::find_if(circles.begin(), circles.end(),
                               [&](const SweptCircle& one) { return one.target == rows[i].target; });
    if (circle == circles.end()) circle = circles.insert(circles.end(), {rows[i].target, {}, {}});
    circle->readings.points.push_back(input.rigid.circle_sweeps[i]);
    if (input.noise) circle->readings.covariances.push_back(input.noise->covarianceAt(rows[i].point, rows[i].from));
    circle->lines.push_back(rows[i].line);
  }
  return axes;
}

AxisUncertainty uncertaintyOf(const metrology::AxisFit& fit) {
  const auto larger = [](const Eigen::Matrix2d& covariance) {
    return std::sqrt(std::max(0.0, symmetricEigenvalues(covariance)[1]));
  };
  // The fit's parameters are taken at axis.line.point; the circles' middle is where the place is known best.
  double middle = 0.0;
  for (const metrology::AxisCircle& circle : fit.circles)
    middle += circle.height / static_cast<double>(fit.circles.size());
  Eigen::Matrix<double, 2, 4> shift;
  shift << Eigen::Matrix2d::Identity(), middle * Eigen::Matrix2d::Identity();
  return {larger(fit.axis.covariance.bottomRightCorner<2, 2>()),
          larger(shift * fit.axis.covariance * shift.transpose())};
}

double arcCost(double arc, int readings) {
  constexpr int kLeast = 4;  // three readings make a circle without a residual: nothing to compare
  const int count = std::max(kLeast, readings);
  return largestSd(arc, count) / largestSd(0.5 * std::numbers::pi, count);
}

}  // namespace stiffscope::audit
