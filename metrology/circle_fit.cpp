#include "metrology/circle_fit.h"

#include "metrology/least_squares.h"
#include "metrology/measured_points.h"
#include "metrology/remarks.h"
#include "metrology/shape_models.h"

namespace stiffscope::metrology {

namespace {

/// Circle in a plane that is given: radial residual rho - r. Shared parameters: shifts of the centre along u
/// and v.
class FlatCircleModel : public AxisModel {
 public:
  using AxisModel::AxisModel;
  Size size() const override { return {2, 1, 1}; }
  void observe(std::size_t, const Eigen::Vector3d& point, const double* radius, Observation& seen) const override {
    const PlaceAboutAxis place = axis.placeOf(point);
    seen.residual[0] = static_cast<double>(place.radius - radius[0]);
    seen.rows[0] = {-place.outward_u, -place.outward_v, -1.0};
    seen.directions[0] = place.outward_u * axis.u() + place.outward_v * axis.v();
  }
  void move(const Eigen::VectorXd& step) override {
    before_ = axis;
    axis.move({step[0], step[1], 0.0, 0.0});
  }
};

/// A model where its fit has left it, and the fit.
struct FittedPart {
  const Model& model;
  const Estimate& estimate;
};

/// Cofactor of (tilt_u, tilt_v, height) with (shift_u, shift_v, radius): each part weighs by its own
/// variance, but a point's radial and axial errors go together where its covariance is not level with the
/// plane.
Eigen::Matrix3d commonPart(const FittedPart& plane, const FittedPart& flat, const LocalPoints& local) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  if (!local.weighted()) return sum;
  const LocalGroup& group = local.groups.front();
  for (std::size_t i = 0; i < group.points.size(); ++i) {
    Observation axial, radial;
    plane.model.observe(i, group.points[i], plane.estimate.own.data(), axial);
    flat.model.observe(i, group.points[i], flat.estimate.own.data(), radial);
    const Eigen::Matrix3d covariance = (*group.covariances)[i] / (local.scale * local.scale);
    const Eigen::Vector3d n = axial.directions[0], e = radial.directions[0];
    const double together = n.dot(covariance * e) / (n.dot(covariance * n) * e.dot(covariance * e));
    sum += together * Eigen::Vector3d(axial.rows[0].data()) * Eigen::RowVector3d(radial.rows[0].data());
  }
  return Eigen::Matrix3d(plane.estimate.cofactor) * sum * Eigen::Matrix3d(flat.estimate.cofactor);
}

/// Of (tilts, height; shifts, radius), local units.
Eigen::Matrix<double, 6, 6> covarianceOfParts(const FittedPart& plane, const FittedPart& flat,
                                              const LocalPoints& local) {
  const double of_plane = varianceFactor(plane.estimate, local.weighted()),
               of_flat = varianceFactor(flat.estimate, local.weighted());
  Eigen::Matrix<double, 6, 6> parts;
  parts.topLeftCorner<3, 3>() = of_plane * plane.estimate.cofactor;
  parts.bottomRightCorner<3, 3>() = of_flat * flat.estimate.cofactor;
  parts.topRightCorner<3, 3>() = std::sqrt(of_plane * of_flat) * commonPart(plane, flat, local);
  parts.bottomLeftCorner<3, 3>() = parts.topRightCorner<3, 3>().transpose();
  return parts;
}

/// fitCircle's plane-first strategy: NIST's strategy 1.
FittedCircle fitPlaneFirst(const LocalPoints& local) {
  FittedCircle fit;
  fit.method = Remark(RemarkId::circle_plane_first);
  const auto start = circlesStart(local, fit.reason);
  if (!start) return fit;
  PlanesModel plane_model(AxisFrame(Eigen::Vector3d::Zero(), start->axis.direction()));
  const Estimate plane = fitLeastSquares(plane_model, local, Eigen::MatrixXd::Zero(1, 1));
  const AxisFrame& tilted = plane_model.axis;
  FlatCircleModel flat_model(AxisFrame(start->axis.point(), tilted.direction()));
  const Estimate flat = fitLeastSquares(flat_model, local, firstOwn(*start, local).topRows<1>());
  if (!describeQuality(plane, local, fit) || !describeQuality(flat, local, fit)) return fit;

  fit.degrees_of_freedom = plane.degreesOfFreedom() + flat.degreesOfFreedom();
  const double plain = plane.plain + flat.plain;
  fit.rms = local.scale * std::sqrt(plain / static_cast<double>(local.count()));
  const int dof = fit.degrees_of_freedom;
  fit.residual_sd = dof > 0 ? local.scale * std::sqrt(plain / dof) : 0.0;
  fit.chi2_per_dof = !local.weighted() ? 1.0 : dof > 0 ? (plane.chi2 + flat.chi2) / dof : 0.0;

  const Eigen::Vector3d across = flat_model.axis.point();
  const double lift = plane.own(0, 0) - tilted.direction().dot(across);
  const Eigen::Vector3d normal = largestPositive(tilted.direction());
  const double sense = normal.dot(tilted.direction()) < 0.0 ? -1.0 : 1.0;
  fit.circle = {local.origin + local.scale * (across + lift * tilted.direction()), normal,
                local.scale * flat.own(0, 0)};
  fit.determined = true;
  if (!tellsUncertainty(flat, local)) return fit;

  Eigen::Matrix<double, 7, 6> full;  // (centre, normal, radius) by (tilts, height; shifts, radius)
  full << -tilted.u().dot(across) * tilted.direction(), -tilted.v().dot(across) * tilted.direction(),
      tilted.direction(), flat_model.axis.u(), flat_model.axis.v(), Eigen::Vector3d::Zero(),  //
      sense * tilted.u(), sense * tilted.v(), Eigen::Matrix<double, 3, 4>::Zero(), Eigen::Matrix<double, 1, 5>::Zero(),
      1.0;
  full.topRows<3>() *= local.scale;
  full.row(6) *= local.scale;
  fit.covariance = full * covarianceOfParts({plane_model, plane}, {flat_model, flat}, local) * full.transpose();
  return fit;
}

FittedCircle fitInSpace(const LocalPoints& local) {
  FittedCircle fit;
  fit.method = Remark(RemarkId::circle_in_space);
  auto model = circlesStart(local, fit.reason);
  if (!model) return fit;
  const Estimate estimate = fitLeastSquares(*model, local, firstOwn(*model, local));
  if (!describeQuality(estimate, local, fit)) return fit;

  const AxisFrame& axis = model->axis;
  const double height = estimate.own(1, 0);
  Eigen::Matrix<double, 7, 6> full;  // (centre, normal, radius) by (shifts, tilts, radius, height)
  const Eigen::Vector3d normal = largestPositive(axis.direction());
  const double sense = normal.dot(axis.direction()) < 0.0 ? -1.0 : 1.0;
  full << axis.u(), axis.v(), height * axis.u(), height * axis.v(), Eigen::Vector3d::Zero(),
      axis.direction(),  //
      Eigen::Matrix<double, 3, 2>::Zero(), sense * axis.u(), sense * axis.v(), Eigen::Matrix<double, 3, 2>::Zero(),
      Eigen::Matrix<double, 1, 4>::Zero(), 1.0, 0.0;
  full.topRows<3>() *= local.scale;
  full.row(6) *= local.scale;
  fit.circle = {local.origin + local.scale * (axis.point() + height * axis.direction()), normal,
                local.scale * estimate.own(0, 0)};
  fit.determined = true;
  if (tellsUncertainty(estimate, local)) {
    fit.covariance = covarianceOf(full, estimate, local.weighted());
  }
  return fit;
}

/// Points on one line but for their scatter have no plane. Points that are exactly on one are told apart
/// later.
bool flatEnough(const LocalPoints& local) {
  const PrincipalAxes axes = principalAxes(local);
  return !spreads(axes.spread[1], axes.spread[2], local) || standsOut(axes.spread[1], axes.spread[0], local.count());
}

/// A number that its own uncertainty contradicts is none.
void refuseWhatIsNotSignificant(FittedCircle& fit) {
  if (!fit.determined || !fit.covariance) return;
  if (std::sqrt(fit.covariance->block<3, 3>(3, 3).trace()) > kNoDirection) {
    fit.reason = Remark(RemarkId::normal_on_line_in_scatter);
  } else if (!curved(fit.circle.radius, std::sqrt((*fit.covariance)(6, 6)))) {
    fit.reason = Remark(RemarkId::radius_of_straight_line);
  }
  if (!fit.reason.empty()) {
    fit.circle = {};
    fit.covariance.reset();
    fit.determined = false;
  }
}

}  // namespace

FittedCircle fitCircle(const MeasuredPoints& points, CircleStrategy strategy) {
  const LocalPoints local = localPoints(&points, 1);
  FittedCircle fit;
  if (Remark few = tooFewReadings(3, points.points.size()); !few.empty()) {
    fit.reason = std::move(few);
  } else if (local.flaw.empty() && !flatEnough(local)) {
    fit.reason = Remark(RemarkId::normal_on_line_in_scatter);
  } else if (local.flaw.empty()) {
    fit = strategy == CircleStrategy::full ? fitInSpace(local) : fitPlaneFirst(local);
  } else {
    fit.reason = local.flaw;
  }
  refuseWhatIsNotSignificant(fit);
  return fit;
}

}  // namespace stiffscope::metrology
