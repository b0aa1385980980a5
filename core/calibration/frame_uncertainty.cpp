#include "core/calibration/calibrate.h"

#include <Eigen/Geometry>
#include <functional>
#include <numbers>

#include "core/frames/arm_parameters.h"
#include "core/robot/inverse_kinematics.h"

namespace stiffscope::calibration {

namespace {

/// What `value` says of the fit, with the standard uncertainty that all its free parameters together give that.
UncertainPoint propagatedThrough(const ArmFit& fit, const std::function<Eigen::Vector3d(const ArmFit&)>& value) {
  constexpr double kStep = frames::ArmParameters::kSmall;
  UncertainPoint point;
  point.value = value(fit);
  Eigen::Matrix<double, 3, Eigen::Dynamic> by_free =
      Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, static_cast<Eigen::Index>(fit.free.size()));
  ArmFit moved = fit;
  for (std::size_t k = 0; k < fit.free.size(); ++k) {
    const Eigen::Index at = fit.free[k];
    if (at >= fit.steps.size()) continue;  // sizes of effects move no frame
    moved.steps[at] = fit.steps[at] + kStep;
    const Eigen::Vector3d up = value(moved);
    moved.steps[at] = fit.steps[at] - kStep;
    by_free.col(static_cast<Eigen::Index>(k)) = (up - value(moved)) / (2.0 * kStep);
    moved.steps[at] = fit.steps[at];
  }
  const Eigen::Matrix3d covariance = by_free * fit.covariance * by_free.transpose();
  point.sd = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  return point;
}

/// Of the vectors that stand for one rotation the one nearer to `near`: at half a turn the axis changes sides.
Eigen::Vector3d sameSide(const Eigen::Vector3d& turn, const Eigen::Vector3d& near) {
  const double angle = turn.norm();
  if (angle == 0.0) return turn;
  const Eigen::Vector3d other = turn * (1.0 - 2.0 * std::numbers::pi / angle);
  return (turn - near).squaredNorm() <= (other - near).squaredNorm() ? turn : other;
}

}  // namespace

UncertainPoint stationInBase(const UnloadedDay& day, const ArmFit& fit) {
  return propagatedThrough(fit, [&](const ArmFit& moved) { return moved.basePointsMotion() * day.station; });
}

UncertainPoint turnOfStation(const ArmFit& fit) {
  const Eigen::Vector3d turn = robot::rotationVector(fit.basePointsMotion().linear());
  return propagatedThrough(fit, [&](const ArmFit& moved) {
    return sameSide(robot::rotationVector(moved.basePointsMotion().linear()), turn);
  });
}

std::vector<UncertainPoint> targetsInFlange(const UnloadedDay& day, const ArmFit& fit) {
  std::vector<UncertainPoint> points;
  for (std::size_t target = 0; target < fit.targetsAtZero().size(); ++target) {
    points.push_back(propagatedThrough(fit, [&](const ArmFit& moved) {
      return moved.arm(day.arm).base_from_flange_at_zero.inverse() * moved.targetsAtZero()[target];
    }));
  }
  return points;
}

}  // namespace stiffscope::calibration
