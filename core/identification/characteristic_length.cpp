#include "core/identification/complete_pose.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/robot/kinematics.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::identification {

namespace {

/// J^T J of the stacked Jacobian, displacement and rotation rows apart: its condition number at any L is that
/// of linear / L^2 + angular, square root taken.
struct StackedJacobian {
  Matrix6d linear = Matrix6d::Zero(), angular = Matrix6d::Zero();

  StackedJacobian(const std::vector<LoadCase>& cases, const Eigen::Vector3d& tcp_in_flange) {
    for (const LoadCase& load_case : cases) {
      const Matrix6d jacobian = robot::jacobianAt(load_case.axes, *load_case.flange_unloaded * tcp_in_flange);
      linear += jacobian.topRows<3>().transpose() * jacobian.topRows<3>();
      angular += jacobian.bottomRows<3>().transpose() * jacobian.bottomRows<3>();
    }
  }

  double condition(double length) const {
    const Matrix6d gram = linear / (length * length) + angular;
    const Eigen::VectorXd values = symmetricEigenvalues(gram);
    return std::sqrt(values[5] / values[0]);
  }
};

}  // namespace

double jacobianCondition(const std::vector<LoadCase>& cases, const Eigen::Vector3d& tcp_in_flange, double length) {
  return StackedJacobian(cases, tcp_in_flange).condition(length);
}

CharacteristicLength characteristicLength(const std::vector<LoadCase>& cases, const Eigen::Vector3d& tcp_in_flange) {
  const StackedJacobian stacked(cases, tcp_in_flange);
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
  double left = low + (best - 1) * step, right = low + (best + 1) * step;
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
