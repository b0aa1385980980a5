#include "core/identification/compensation.h"

#include <algorithm>
#include <numeric>

namespace stiffscope {

DeflectionJudge::DeflectionJudge(const std::vector<CaseEquations>& equations) {
  Eigen::Index count = 0;
  for (const CaseEquations& one : equations) count += one.right.size() / 3;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    matrix_[axis].resize(count, 6);
    right_[axis].resize(count);
  }
  Eigen::Index at = 0;
  for (std::size_t posture = 0; posture < equations.size(); ++posture) {
    const CaseEquations& one = equations[posture];
    const Eigen::Index points = one.right.size() / 3;
    double sum = 0.0;
    for (Eigen::Index point = 0; point < points; ++point, ++at) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        matrix_[static_cast<std::size_t>(axis)].row(at) = one.matrix.row(3 * point + axis).array();
        right_[static_cast<std::size_t>(axis)][at] = one.right[3 * point + axis];
      }
      posture_of_point_.push_back(posture);
      sum += one.right.segment<3>(3 * point).norm();
    }
    points_.push_back(static_cast<int>(points));
    displacement_.push_back(sum);
  }
}

namespace {

constexpr Eigen::Index kBlock = 64;  // points at a time, on the stack

}  // namespace

void DeflectionJudge::addResidual(Eigen::Index from, Eigen::Index size, const Vector6d& compliance,
                                  std::vector<double>& per_posture) const {
  std::array<double, kBlock> norms;
  Eigen::Map<Eigen::ArrayXd> squares(norms.data(), size);
  squares.setZero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto rows = matrix_[axis].middleRows(from, size);
    squares += (right_[axis].segment(from, size) - rows.col(0) * compliance[0] -
                rows.col(1) * compliance[1] - rows.col(2) * compliance[2] - rows.col(3) * compliance[3] -
                rows.col(4) * compliance[4] - rows.col(5) * compliance[5])
                   .square();
  }
  squares = squares.sqrt();
  for (Eigen::Index point = 0; point < size; ++point) {
    per_posture[posture_of_point_[static_cast<std::size_t>(from + point)]] +=
        norms[static_cast<std::size_t>(point)];
  }
}

void DeflectionJudge::residuals(std::span<const Vector6d> compliances,
                                std::span<std::vector<double>* const> per_posture) const {
  for (std::vector<double>* one : per_posture) one->assign(displacement_.size(), 0.0);
  const Eigen::Index count = right_[0].size();
  for (Eigen::Index from = 0; from < count; from += kBlock) {
    for (std::size_t k = 0; k < compliances.size(); ++k) {
      addResidual(from, std::min(kBlock, count - from), compliances[k], *per_posture[k]);
    }
  }
}

std::vector<double> DeflectionJudge::residual(const Vector6d& compliance) const {
  std::vector<double> per_posture;
  std::vector<double>* const into = &per_posture;
  residuals({&compliance, 1}, {&into, 1});
  return per_posture;
}

double DeflectionJudge::compensated(const Vector6d& compliance) const {
  const std::vector<double> left = residual(compliance);
  return 1.0 - std::accumulate(left.begin(), left.end(), 0.0) /
                   std::accumulate(displacement_.begin(), displacement_.end(), 0.0);
}

}  // namespace stiffscope
