#include "metrology/axis_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "metrology/least_squares.h"
#include "metrology/lines.h"
#include "metrology/remarks.h"
#include "metrology/shape_models.h"

namespace stiffscope::metrology {

double sweptArc(const Line& axis, const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < 2) return 0.0;
  Eigen::Vector3d u, v;
  basisAcross(axis.direction, u, v);
  std::vector<double> angles;
  angles.reserve(points.size());
  for (const auto& point : points) {
    angles.push_back(std::atan2(v.dot(point - axis.point), u.dot(point - axis.point)));
  }
  std::sort(angles.begin(), angles.end());
  double gap = 2.0 * std::numbers::pi - (angles.back() - angles.front());
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  return 2.0 * std::numbers::pi - gap;
}

namespace {

Remark tooFew(const std::vector<CirclePoints>& circles) {
  const auto holdsPlane = [](const CirclePoints& circle) { return circle.points.size() >= 3; };
  const auto isEmpty = [](const CirclePoints& circle) { return circle.points.empty(); };
  if (std::none_of(circles.begin(), circles.end(), holdsPlane)) return Remark(RemarkId::no_reflector_with_three);
  if (std::any_of(circles.begin(), circles.end(), isEmpty)) return Remark(RemarkId::reflector_without_readings);
  return {};
}

AxisCircle circleOf(const CirclesModel& model, const Estimate& estimate, const LocalPoints& local, std::size_t k,
                    const Line& axis, const std::vector<Eigen::Vector3d>& points) {
  const double* own = &estimate.own(0, static_cast<Eigen::Index>(k));
  double sum = 0.0;
  Observation seen;
  for (std::size_t i = 0; i < local.groups[k].points.size(); ++i) {
    model.observe(i, local.groups[k].points[i], own, seen);
    sum += seen.squaredNorm(model.size().residuals);
  }
  return {local.scale * own[0], local.scale * own[1], sweptArc(axis, points),
          local.scale * std::sqrt(sum / (2.0 * static_cast<double>(points.size())))};
}

}  // namespace

AxisFit fitAxis(const std::vector<CirclePoints>& circles) {
  AxisFit fit;
  fit.reason = tooFew(circles);
  if (!fit.reason.empty()) return fit;
  const LocalPoints local = localPoints(circles.data(), circles.size());
  fit.reason = local.flaw;
  if (!fit.reason.empty()) return fit;
  auto model = circlesStart(local, fit.reason);
  if (!model) return fit;

  const Estimate estimate = fitLeastSquares(*model, local, firstOwn(*model, local));
  fit.degrees_of_freedom = estimate.degreesOfFreedom();
  if (fit.degrees_of_freedom < 1) {
    fit.reason = Remark(RemarkId::too_few_for_axis);
    return fit;
  }
  if (!estimate.determined) {
    fit.reason = Remark(RemarkId::axis_not_determined);
    return fit;
  }
  fit.axis = model->axis.measured();
  fit.axis.line.point = local.origin + local.scale * fit.axis.line.point;
  const Eigen::Vector4d units(local.scale, local.scale, 1.0, 1.0);
  const Eigen::Matrix4d cofactor = estimate.cofactor.topLeftCorner<4, 4>();
  fit.axis.covariance =
      varianceFactor(estimate, local.weighted()) * (units.asDiagonal() * cofactor * units.asDiagonal());
  fit.rms = local.scale * std::sqrt(estimate.plain / estimate.residuals);
  fit.chi2_per_dof = local.weighted() ? estimate.chi2 / fit.degrees_of_freedom : 1.0;
  for (std::size_t k = 0; k < circles.size(); ++k) {
    fit.circles.push_back(circleOf(*model, estimate, local, k, fit.axis.line, circles[k].points));
  }
  fit.determined = true;
  return fit;
}

}  // namespace stiffscope::metrology
