#include "metrology/circle_fit.h"

#include "metrology/circle_start.h"
#include "metrology/finish_fit.h"
#include "metrology/least_readings.h"
#include "metrology/plane_first_circle.h"

namespace stiffscope {

namespace {

FittedCircle fitInSpace(const LocalPoints& local) {
  FittedCircle fit;
  fit.method = "full: orthogonal distances in space, Gauss-Newton from Taubin's circle";
  auto start = circlesStart(local, fit.reason);
  if (!start) return fit;
  Estimate<CirclesModel, 1> estimate{*start, firstOwn(*start, local)};
  refine(estimate, local);
  if (!describeQuality(estimate, local, fit)) return fit;

  const AxisFrame& axis = estimate.model.axis;
  const double height = estimate.own(1, 0);
  Eigen::Matrix<double, 7, 6> full;  // (centre, normal, radius) by (shifts, tilts, radius, height)
  const Eigen::Vector3d normal = largestPositive(axis.direction());
  const double sense = normal.dot(axis.direction()) < 0.0 ? -1.0 : 1.0;
  full << axis.u(), axis.v(), height * axis.u(), height * axis.v(), Eigen::Vector3d::Zero(),
      axis.direction(),  //
      Eigen::Matrix<double, 3, 2>::Zero(), sense * axis.u(), sense * axis.v(),
      Eigen::Matrix<double, 3, 2>::Zero(), Eigen::Matrix<double, 1, 4>::Zero(), 1.0, 0.0;
  full.topRows<3>() *= local.scale;
  full.row(6) *= local.scale;
  fit.circle = {local.origin + local.scale * (axis.point() + height * axis.direction()), normal,
                local.scale * estimate.own(0, 0)};
  fit.determined = true;
  if (tellsUncertainty(estimate, local)) {
    fit.covariance =
        varianceFactor(estimate, local.weighted()) * (full * estimate.cofactor * full.transpose()).eval();
  }
  return fit;
}

/// Points on one line but for their scatter have no plane. Points that are exactly on one are told apart
/// later.
bool flatEnough(const LocalPoints& local) {
  const PrincipalAxes axes = principalAxes(local);
  return !spreads(axes.spread[1], axes.spread[2], local) ||
         standsOut(axes.spread[1], axes.spread[0], local.count());
}

/// A number that its own uncertainty contradicts is none.
void refuseWhatIsNotSignificant(FittedCircle& fit) {
  if (!fit.determined || !fit.covariance) return;
  if (std::sqrt(fit.covariance->block<3, 3>(3, 3).trace()) > kNoDirection) {
    fit.reason = "the normal is undetermined: the readings lie on one line within their scatter";
  } else if (!curved(fit.circle.radius, std::sqrt((*fit.covariance)(6, 6)))) {
    fit.reason =
        "the radius is undetermined: against their scatter the readings could lie on a straight line";
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
  if (std::string few = tooFewReadings(3, points.points.size()); !few.empty()) {
    fit.reason = std::move(few);
  } else if (local.flaw.empty() && !flatEnough(local)) {
    fit.reason = "the normal is undetermined: the readings lie on one line within their scatter";
  } else if (local.flaw.empty()) {
    fit = strategy == CircleStrategy::full ? fitInSpace(local) : fitPlaneFirst(local);
  } else {
    fit.reason = local.flaw;
  }
  refuseWhatIsNotSignificant(fit);
  return fit;
}

}  // namespace stiffscope
