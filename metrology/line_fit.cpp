#include "metrology/line_fit.h"

#include <algorithm>
#include <cmath>

#include "metrology/measured_points.h"
#include "metrology/remarks.h"
#include "metrology/shape_models.h"

namespace stiffscope::metrology {

FittedLine fitLine(const MeasuredPoints& points) {
  FittedLine fit;
  fit.method = Remark(RemarkId::line_orthogonal);
  const LocalPoints local = localPoints(&points, 1);
  fit.reason = tooFewReadings(2, points.points.size());
  if (fit.reason.empty()) fit.reason = local.flaw;
  if (!fit.reason.empty()) return fit;
  const PrincipalAxes axes = principalAxes(local);
  if (!standsOut(axes.spread[2], axes.spread[1], local.count())) {
    fit.reason = Remark(RemarkId::direction_spread_alike);
    return fit;
  }
  LineModel model(AxisFrame(Eigen::Vector3d::Zero(), axes.directions.col(2)));
  const Estimate estimate = fitLeastSquares(model, local);
  if (!describeQuality(estimate, local, fit)) return fit;

  const AxisFrame& axis = model.axis;
  const double along = -axis.direction().dot(axis.point());
  const Eigen::Vector3d direction = largestPositive(axis.direction());
  const double sense = direction.dot(axis.direction()) < 0.0 ? -1.0 : 1.0;
  Eigen::Matrix<double, 6, 4> full;                                // (point, direction) by (shifts, tilts)
  full << axis.u(), axis.v(), along * axis.u(), along * axis.v(),  //
      Eigen::Matrix<double, 3, 2>::Zero(), sense * axis.u(), sense * axis.v();
  full.topRows<3>() *= local.scale;
  if (tellsUncertainty(estimate, local)) {
    const double factor = varianceFactor(estimate, local.weighted());
    if (std::sqrt(factor * std::max(estimate.cofactor(2, 2), estimate.cofactor(3, 3))) > kNoDirection) {
      fit.reason = Remark(RemarkId::direction_scatter_as_spread);
      return fit;
    }
    fit.covariance = covarianceOf(full, estimate, local.weighted());
  }
  fit.line = {local.origin + local.scale * (axis.point() + along * axis.direction()), direction};
  fit.determined = true;
  return fit;
}

}  // namespace stiffscope::metrology
