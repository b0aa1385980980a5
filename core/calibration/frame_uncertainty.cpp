#include "core/calibration/calibrate.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/frames/arm_parameters.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::calibration {

namespace {

/// Covariance of `count` parameters from `first` on; zero where they are held.
Eigen::MatrixXd covarianceFrom(const ArmFit& fit, Eigen::Index first, Eigen::Index count) {
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(count, count);
  for (std::size_t a = 0; a < fit.free.size(); ++a) {
    const Eigen::Index i = fit.free[a] - first;
    for (std::size_t b = 0; b < fit.free.size(); ++b) {
      const Eigen::Index k = fit.free[b] - first;
      if (i >= 0 && i < count && k >= 0 && k < count)
        block(i, k) = fit.covariance(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
    }
  }
  return block;
}

Eigen::Vector3d sdOf(const Eigen::Matrix3d& covariance) { return covariance.diagonal().cwiseMax(0.0).cwiseSqrt(); }

}  // namespace

UncertainPoint stationInBase(const UnloadedDay& day, const ArmFit& fit) {
  UncertainPoint point;
  point.value = fit.basePointsMotion() * day.station;
  Eigen::Matrix<double, 3, 6> by_base;
  const Eigen::Vector3d lever = point.value - fit.centre;
  for (int k = 0; k < 3; ++k) by_base.col(k) = Eigen::Vector3d::Unit(k).cross(lever);
  by_base.rightCols<3>().setIdentity();
  point.sd = sdOf(propagated(by_base, covarianceFrom(fit, fit.places().baseAt(), 6)));
  return point;
}

UncertainPoint turnOfStation(const ArmFit& fit) {
  const Eigen::AngleAxisd turn(fit.basePointsMotion().linear());
  return {turn.angle() * turn.axis(), sdOf(covarianceFrom(fit, fit.places().baseAt(), 3))};
}

std::vector<UncertainPoint> targetsInFlange(const UnloadedDay& day, const ArmFit& fit) {
  const Eigen::Isometry3d flange_from_base = fit.arm(day.arm).base_from_flange_at_zero.inverse();
  const Eigen::Matrix3d turn = flange_from_base.linear();
  std::vector<UncertainPoint> points;
  for (const Eigen::Vector3d& at_zero : fit.targetsAtZero()) {
    const Eigen::MatrixXd covariance = covarianceFrom(fit, fit.places().targetAt(points.size()), 3);
    points.push_back({flange_from_base * at_zero, sdOf(turn * covariance * turn.transpose())});
  }
  return points;
}

}  // namespace stiffscope::calibration
