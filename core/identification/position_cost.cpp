#include "core/identification/position_cost.h"

#include <ceres/jet.h>

namespace stiffscope {

namespace {

/// A block of derivatives as the solver keeps it: row by row.
template <int Columns>
auto derivatives(double* at) {
  return Eigen::Map<Eigen::Matrix<double, 3, Columns, Eigen::RowMajor>>(at);
}

/// Derivatives of a step of the chain by its own numbers and by the point that comes in.
template <int Own>
struct Step {
  Eigen::Vector3d out;
  Eigen::Matrix<double, 3, Own> by_own;
  Eigen::Matrix3d by_point;
};

/// `step(own, point)` for numbers and points of any scalar.
template <int Own, class Function>
Step<Own> differentiated(const double* own, const Eigen::Vector3d& point, const Function& step) {
  using Jet = ceres::Jet<double, Own + 3>;
  std::array<Jet, Own> numbers;
  for (int k = 0; k < Own; ++k) numbers[static_cast<std::size_t>(k)] = Jet(own[k], k);
  const Eigen::Matrix<Jet, 3, 1> moving(Jet(point.x(), Own), Jet(point.y(), Own + 1),
                                        Jet(point.z(), Own + 2));
  const Eigen::Matrix<Jet, 3, 1> moved = step(numbers.data(), moving);
  Step<Own> result;
  for (int row = 0; row < 3; ++row) {
    result.out[row] = moved[row].a;
    result.by_own.row(row) = moved[row].v.template head<Own>().transpose();
    result.by_point.row(row) = moved[row].v.template tail<3>().transpose();
  }
  return result;
}

}  // namespace

bool PositionCost::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const double *axes = parameters[0], *base = parameters[1], *target = parameters[2];
  if (jacobians == nullptr) return residual_(axes, base, target, residuals);
  Eigen::Vector3d x(target[0], target[1], target[2]);
  std::array<Step<4>, 6> joints;
  for (int joint = 5; joint >= 0; --joint) {
    joints[static_cast<std::size_t>(joint)] = differentiated<4>(
        axes + 4 * joint, x,
        [&](const auto* own, const auto& point) { return residual_.turned(joint, own, point); });
    x = joints[static_cast<std::size_t>(joint)].out;
  }
  const Step<6> placed = differentiated<6>(
      base, x, [&](const auto* own, const auto& point) { return residual_.placed(own, point); });
  Eigen::Map<Eigen::Vector3d> left(residuals);
  left = residual_.whiten * (residual_.measured - placed.out);
  if (jacobians[1] != nullptr) derivatives<6>(jacobians[1]) = -residual_.whiten * placed.by_own;
  Eigen::Matrix3d chain = -residual_.whiten * placed.by_point;
  for (int joint = 0; joint < 6; ++joint) {
    const Step<4>& step = joints[static_cast<std::size_t>(joint)];
    if (jacobians[0] != nullptr) {
      derivatives<24>(jacobians[0]).middleCols<4>(4 * joint) = chain * step.by_own;
    }
    chain = (chain * step.by_point).eval();
  }
  if (jacobians[2] != nullptr) derivatives<3>(jacobians[2]) = chain;
  return true;
}

}  // namespace stiffscope
