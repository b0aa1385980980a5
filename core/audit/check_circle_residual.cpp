#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/audit/chance.h"
#include "core/audit/checks.h"
#include "core/audit/finding.h"
#include "core/audit/limits.h"
#include "core/audit/rows.h"
#include "core/audit/swept_circles.h"

namespace stiffscope {

namespace {

using namespace audit_limits;

/// The reading that is farthest from its circle.
struct WorstReading {
  std::size_t line = 0;
  double share = 0.0;  ///< of the sum of squared distances from the circles
};

WorstReading worstReading(const MeasuredAxis& axis, const std::vector<SweptCircle>& circles) {
  WorstReading worst;
  double farthest = -1.0, sum = 0.0;
  for (std::size_t k = 0; k < circles.size(); ++k) {
    for (std::size_t i = 0; i < circles[k].lines.size(); ++i) {
      const Eigen::Vector3d from_axis = circles[k].readings.points[i] - axis.fit.axis.line.point;
      const double height = axis.fit.axis.line.direction.dot(from_axis);
      const double radius = (from_axis - height * axis.fit.axis.line.direction).norm();
      const double off = std::hypot(radius - axis.fit.circles[k].radius, height - axis.fit.circles[k].height);
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
      single_ += fmt::format("; most of that of axis {} is the one reading {}", axis + 1, row);
    } else {
      running_.push_back(axis + 1);
    }
  }

  std::string words() const {
    if (running_.empty()) return single_;
    return single_ +
           fmt::format(
               "; that of ax{} {} runs along the sweep, no one reading makes it: the axis moves as it turns, "
               "most often because the own weight bends bearings or links, which joint springs do not "
               "describe; identification goes on",
               running_.size() == 1 ? "is" : "es", fmt::join(running_, ", "));
  }

 private:
  std::string single_;
  std::vector<std::size_t> running_;
};

AuditCheck residualCheck(const Evidence& evidence, const std::array<std::vector<SweptCircle>, 6>& axes) {
  AuditCheck check;
  check.id = "circle_residual";
  check.unit = "of noise sd";
  check.limit_source = byChance("chi-square of each axis's residuals");
  check.value = 0.0;
  std::vector<std::string> beyond;
  Causes causes;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const MeasuredAxis& measured = evidence.frames.axes[axis];
    const AxisFit& fit = measured.fit;
    if (!fit.determined) continue;
    const double limit = chiSquareLimit(kLevel / 6.0, fit.degrees_of_freedom) / fit.degrees_of_freedom;
    const double ratio = std::sqrt(fit.chi2_per_dof);
    const WorstReading worst = worstReading(measured, axes[axis]);
    const std::string row = rowName(evidence.campaign.circle_sweeps->file, worst.line);
    if (fit.chi2_per_dof > limit) {
      beyond.push_back(
          fmt::format("axis {} by {:.1f} um rms, {:.2f} of the noise", axis + 1, 1e6 * fit.rms, ratio));
      causes.add(axis, worst, row);
    }
    if (ratio <= *check.value) continue;
    check.value = ratio;
    check.limit = std::sqrt(limit);
    check.where = fmt::format("{}, {}", axisName(axis), row);
  }
  check.message = "readings lie on their circles within the noise";
  if (beyond.empty()) return check;
  check.verdict = AuditVerdict::warn;
  check.message = fmt::format(
      "readings leave their circles by more than noise: {}; the stated uncertainties of the axes are widened "
      "by "
      "it{}",
      fmt::join(beyond, ", "), causes.words());
  return check;
}

}  // namespace

Findings checkCircleResidual(const Evidence& evidence) {
  if (!evidence.campaign.circle_sweeps) return {notTestable("circle_residual", kNoSweeps)};
  if (!evidence.noise) {
    return {notTestable("circle_residual", "the tracker's noise is not declared: state `tracker`")};
  }
  return {residualCheck(evidence, sweptCircles(evidence))};
}

}  // namespace stiffscope
