#include "core/identification/complete_pose.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/numerics/parallel.h"
#include "core/robot/kinematics.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::identification {

namespace {

/// J^T J of the stacked Jacobian, displacement and rotation rows apart: its condition number at any L is that
/// of linear / L^2 + angular, square root taken.
struct StackedJacobian {
  JointMatrix linear, angular;  // none before the first posture

  StackedJacobian& operator+=(const StackedJacobian& other) {
    if (other.linear.size() == 0) return *this;
    if (linear.size() == 0) return *this = other;
    linear += other.linear;
    angular += other.angular;
    return *this;
  }

  double condition(double length) const {
    const JointMatrix gram = linear / (length * length) + angular;
    const Eigen::VectorXd values = symmetricEigenvalues(gram);
    return std::sqrt(values[values.size() - 1] / values[0]);
  }
};

StackedJacobian stackedJacobian(const std::vector<LoadCase>& cases, const Eigen::Vector3d& tcp_in_flange) {
  return numerics::sumInBlocks<StackedJacobian>(cases.size(), [&](std::size_t i, StackedJacobian& sum) {
    const Jacobian jacobian = robot::jacobianAt(cases[i].axes, *cases[i].flange_unloaded * tcp_in_flange);
    const Eigen::Index joints = jacobian.cols();
    if (sum.linear.size() == 0) sum.linear = sum.angular = JointMatrix::Zero(joints, joints);
    sum.linear += jacobian.topRows<3>().transpose().lazyProduct(jacobian.topRows<3>());
    sum.angular += jacobian.bottomRows<3>().transpose().lazyProduct(jacobian.bottomRows<3>());
  });
}

}  // namespace

double jacobianCondition(const std::vector<LoadCase>& cases, const Eigen::Vector3d& tcp_in_flange, double length) {
  return stackedJacobian(cases, tcp_in_flange).condition(length);
}

CharacteristicLength characteristicLength(const std::vector<LoadCase>& cases, const Eigen::Vector3d& tcp_in_flange) {
  const StackedJacobian stacked = stackedJacobian(cases, tcp_in_flange);
  CharacteristicLength result;
  constexpr int kPoints = 61;
  const double low = std::log(kShortestLength), high = std::log(kLongestLength), step = (high - low) / (kPoints - 1);
  int best = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double length = std::exp(low + i * step);
    result.curve.emplace_back(length, stacked.condition(length));
    if (result.curve.back().second < result.curve[static_cast<std::size_t>(best)].second) best = i;
  }
  const double golden = (std::sqrt(5.0) - 1.0) / 2.0;
  double left = low + std::max(best - 1, 0) * step, right = low + std::min(best + 1, kPoints - 1) * step;
  constexpr double kClose = 1e-6;
  while (right - left > kClose) {
    const double a = right - golden * (right - left), b = left + golden * (right - left);
    (stacked.condition(std::exp(a)) < stacked.condition(std::exp(b)) ? right : left) =
        stacked.condition(std::exp(a)) < stacked.condition(std::exp(b)) ? b : a;
  }
  result.length = std::exp(0.5 * (left + right));
  result.condition = stacked.condition(result.length);
  return result;
}

}  // namespace stiffscope::identification
