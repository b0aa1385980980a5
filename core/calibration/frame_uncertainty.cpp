#include "core/calibration/calibrate.h"

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/frames/arm_parameters.h"
#include "core/robot/inverse_kinematics.h"

namespace stiffscope::calibration {

namespace {

/// Standard uncertainties that all free parameters of the fit together give what `value` says of it, to first order.
Eigen::VectorXd propagatedThrough(const ArmFit& fit, const std::function<Eigen::VectorXd(const ArmFit&)>& value) {
  constexpr double kStep = frames::ArmParameters::kSmall;
  Eigen::MatrixXd by_free = Eigen::MatrixXd::Zero(value(fit).size(), static_cast<Eigen::Index>(fit.free.size()));
  ArmFit moved = fit;
  for (std::size_t k = 0; k < fit.free.size(); ++k) {
    const Eigen::Index at = fit.free[k];
    if (at >= fit.steps.size()) continue;  // sizes of effects move no frame
    moved.steps[at] = fit.steps[at] + kStep;
    const Eigen::VectorXd up = value(moved);
    moved.steps[at] = fit.steps[at] - kStep;
    by_free.col(static_cast<Eigen::Index>(k)) = (up - value(moved)) / (2.0 * kStep);
    moved.steps[at] = fit.steps[at];
  }
  const Eigen::MatrixXd covariance = by_free * fit.covariance * by_free.transpose();
  return covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

UncertainPoint pointOf(const ArmFit& fit, const std::function<Eigen::Vector3d(const ArmFit&)>& value) {
  return {value(fit), propagatedThrough(fit, value)};
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
  return pointOf(fit, [&](const ArmFit& moved) { return moved.basePointsMotion() * day.station; });
}

UncertainPoint turnOfStation(const ArmFit& fit) {
  const Eigen::Vector3d turn = robot::rotationVector(fit.basePointsMotion().linear());
  return pointOf(fit, [&](const ArmFit& moved) {
    return sameSide(robot::rotationVector(moved.basePointsMotion().linear()), turn);
  });
}

std::vector<UncertainPoint> targetsInFlange(const UnloadedDay& day, const ArmFit& fit) {
  std::vector<UncertainPoint> points;
  for (std::size_t target = 0; target < fit.targetsAtZero().size(); ++target) {
    points.push_back(pointOf(fit, [&](const ArmFit& moved) {
      return moved.arm(day.arm).base_from_flange_at_zero.inverse() * moved.targetsAtZero()[target];
    }));
  }
  return points;
}

namespace {

constexpr Eigen::Index kOfLink = 5, kAnglesOfLink = 3;

/// Angles first.
Eigen::VectorXd numbersOf(const DenavitHartenberg& parameters) {
  Eigen::VectorXd numbers(kOfLink * static_cast<Eigen::Index>(parameters.links.size()));
  Eigen::Index at = 0;
  for (const LinkParameters& link : parameters.links) {
    numbers.segment<kOfLink>(at) << link.theta, link.alpha, link.beta, link.d, link.a;
    at += kOfLink;
  }
  return numbers;
}

}  // namespace

PerJoint<LinkParameters> linkUncertainties(const ArmFit& fit, const robot::Robot& nominal) {
  const Eigen::VectorXd middle = numbersOf(denavitHartenberg(fit.arm(nominal), nominal));
  const Eigen::VectorXd sd = propagatedThrough(fit, [&](const ArmFit& moved) -> Eigen::VectorXd {
    Eigen::VectorXd numbers = numbersOf(denavitHartenberg(moved.arm(nominal), nominal));
    // Of angles a full turn is no difference.
    for (Eigen::Index i = 0; i < numbers.size(); ++i)
      if (i % kOfLink < kAnglesOfLink)
        numbers[i] = middle[i] + std::remainder(numbers[i] - middle[i], 2.0 * std::numbers::pi);
    return numbers;
  });
  PerJoint<LinkParameters> links(static_cast<std::size_t>(middle.size() / kOfLink));
  Eigen::Index at = 0;
  for (LinkParameters& link : links) {
    link.theta = sd[at], link.alpha = sd[at + 1], link.beta = sd[at + 2], link.d = sd[at + 3], link.a = sd[at + 4];
    at += kOfLink;
  }
  return withoutRounding(std::move(links));
}

}  // namespace stiffscope::calibration
