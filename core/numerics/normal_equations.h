#pragma once

#include <Eigen/Core>
#include <vector>

namespace stiffscope::numerics {

/// Columns of a Jacobian that the data cannot tell from those before them, in the order given: what is left
/// of such a column across the span of the earlier ones is under 1e-3 of its length. Parameters that the data
/// would rather determine come first in `order`.
std::vector<int> columnsInSpanOfEarlier(const Eigen::MatrixXd& jacobian, const std::vector<int>& order);

/// [A y]^T [A y] of whitened equations; half of it computed, the rest mirrored.
Eigen::MatrixXd normalMatrix(const Eigen::MatrixXd& equations);

/// Half of a symmetric matrix, its lower triangle column by column: of many matrices that are only summed.
class LowerTriangle {
 public:
  LowerTriangle() = default;
  explicit LowerTriangle(const Eigen::MatrixXd& symmetric) : values_(symmetric.rows() * (symmetric.rows() + 1) / 2) {
    Eigen::Index at = 0;
    for (Eigen::Index column = 0, left = symmetric.rows(); left > 0; ++column, at += left, --left) {
      values_.segment(at, left) = symmetric.col(column).tail(left);
    }
  }

  /// Adds `weight` times it to the lower triangle of `sum`.
  void addTo(double weight, Eigen::MatrixXd& sum) const { addTo(weight, sum, 0, sum.cols()); }

  /// The same of `count` columns from `first` on.
  void addTo(double weight, Eigen::MatrixXd& sum, Eigen::Index first, Eigen::Index count) const {
    const Eigen::Index rows = sum.rows();
    Eigen::Index at = first * rows - first * (first - 1) / 2;
    for (Eigen::Index column = first; column < first + count; ++column) {
      const Eigen::Index left = rows - column;
      sum.col(column).tail(left) += weight * values_.segment(at, left);
      at += left;
    }
  }

 private:
  Eigen::VectorXd values_;
};

}  // namespace stiffscope::numerics
