#include "metrology/plane_fit.h"

#include <algorithm>
#include <cmath>

#include "metrology/measured_points.h"
#include "metrology/remarks.h"
#include "metrology/shape_models.h"

namespace stiffscope::metrology {

FittedPlane fitPlane(const MeasuredPoints& points) {
  FittedPlane fit;
  fit.method = Remark(RemarkId::plane_orthogonal);
  const LocalPoints local = localPoints(&points, 1);
  fit.reason = tooFewReadings(3, points.points.size());
  if (fit.reason.empty()) fit.reason = local.flaw;
  if (!fit.reason.empty()) return fit;
  const PrincipalAxes axes = principalAxes(local);
  if (!spreads(axes.spread[1], axes.spread[2], local)) {
    fit.reason = Remark(RemarkId::normal_on_one_line);
    return fit;
  }
  if (!standsOut(axes.spread[1], axes.spread[0], local.count())) {
    fit.reason = Remark(RemarkId::normal_spread_alike);
    return fit;
  }
  PlanesModel model(AxisFrame(Eigen::Vector3d::Zero(), axes.directions.col(0)));
  const Estimate estimate = fitLeastSquares(model, local, Eigen::MatrixXd::Zero(1, 1));
  if (!describeQuality(estimate, local, fit)) return fit;

  const AxisFrame& frame = model.axis;
  const Eigen::Vector3d normal = largestPositive(frame.direction());
  const double sense = normal.dot(frame.direction()) < 0.0 ? -1.0 : 1.0;
  Eigen::Matrix<double, 6, 3> full;                                              // (point, normal) by (tilts, height)
  full << Eigen::Matrix<double, 3, 2>::Zero(), local.scale * frame.direction(),  //
      sense * frame.u(), sense * frame.v(), Eigen::Vector3d::Zero();
  if (tellsUncertainty(estimate, local)) {
    const double factor = varianceFactor(estimate, local.weighted());
    if (std::sqrt(factor * std::max(estimate.cofactor(0, 0), estimate.cofactor(1, 1))) > kNoDirection) {
      fit.reason = Remark(RemarkId::normal_on_line_in_scatter);
      return fit;
    }
    fit.covariance = covarianceOf(full, estimate, local.weighted());
  }
  fit.plane = {local.origin + local.scale * estimate.own(0, 0) * frame.direction(), normal};
  fit.determined = true;
  return fit;
}

}  // namespace stiffscope::metrology
