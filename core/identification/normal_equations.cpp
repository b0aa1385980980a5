#include "core/identification/normal_equations.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel/sum_in_blocks.h"

namespace stiffscope {

namespace {

/// R of A = Q R, A given in blocks of rows: the rows at hand under what the earlier ones left.
class TriangularFactor {
 public:
  void add(const Eigen::Matrix<double, Eigen::Dynamic, 6>& rows) {
    rows_ += rows.rows();
    for (Eigen::Index from = 0; from < rows.rows();) {
      const Eigen::Index count = std::min(rows.rows() - from, kRows - filled_);
      work_.middleRows(filled_, count) = rows.middleRows(from, count);
      filled_ += count, from += count;
      if (filled_ == kRows) reduce();
    }
  }

  /// With the rows under the other one's, too.
  TriangularFactor& operator+=(TriangularFactor& other) {
    add(other.triangle());
    rows_ += other.rows_ - 6;
    return *this;
  }

  /// Of all rows.
  Eigen::Index rows() const { return rows_; }

  Matrix6d triangle() {
    reduce();
    return work_.topRows<6>();
  }

 private:
  void reduce() {
    work_.bottomRows(kRows - filled_).setZero();
    const Matrix6d triangle = work_.householderQr().matrixQR().topRows<6>().triangularView<Eigen::Upper>();
    work_.topRows<6>() = triangle;
    filled_ = 6;
  }

  static constexpr Eigen::Index kRows = 96;
  Eigen::Matrix<double, kRows, 6> work_;
  Eigen::Index filled_ = 0, rows_ = 0;
};

}  // namespace

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  matrix += other.matrix;
  right += other.right;
  return *this;
}

NormalEquations normalEquations(const CaseEquations& equations) {
  // By columns: for few rows a general matrix product costs more in its preparations than it computes.
  NormalEquations normal;
  for (int i = 0; i < 6; ++i) {
    const auto column = equations.matrix.col(i);
    for (int j = 0; j <= i; ++j) {
      normal.matrix(i, j) = normal.matrix(j, i) = column.dot(equations.matrix.col(j));
    }
    normal.right[i] = column.dot(equations.right);
  }
  return normal;
}

NormalEquations normalEquations(const std::vector<CaseEquations>& equations) {
  NormalEquations sum;
  for (const CaseEquations& one : equations) sum += normalEquations(one);
  return sum;
}

NormalEquations sumOf(const std::vector<NormalEquations>& normal) {
  NormalEquations sum;
  for (const NormalEquations& one : normal) sum += one;
  return sum;
}

ScaledNormal scaledNormal(const Matrix6d& matrix, const JointMask& unknown) {
  // Joints left out get a unit diagonal: one fixed-size solve serves every mask.
  ScaledNormal scaled{matrix, Vector6d::Zero()};
  for (int j = 0; j < 6; ++j) {
    if (unknown[static_cast<std::size_t>(j)] && matrix(j, j) > 0.0)
      scaled.scale[j] = 1.0 / std::sqrt(matrix(j, j));
  }
  scaled.matrix = scaled.scale.asDiagonal() * matrix * scaled.scale.asDiagonal();
  for (int j = 0; j < 6; ++j) {
    if (scaled.scale[j] == 0.0) scaled.matrix(j, j) = 1.0;
  }
  return scaled;
}

Vector6d solveNormal(const NormalEquations& sum, const JointMask& unknown) {
  const ScaledNormal scaled = scaledNormal(sum.matrix, unknown);
  const Vector6d right = scaled.scale.cwiseProduct(sum.right);
  // The plain Cholesky factors are twice as quick, which counts over 92,378 subsets; the pivoted ones bear a
  // rank loss.
  const Eigen::LLT<Matrix6d> quick(scaled.matrix);
  const Vector6d solution =
      quick.info() == Eigen::Success ? quick.solve(right).eval() : scaled.matrix.ldlt().solve(right).eval();
  return scaled.scale.cwiseProduct(solution);
}

double conditionNumber(const std::vector<CaseEquations>& equations, const JointMask& unknown) {
  auto factor = sumInBlocks<TriangularFactor>(
      equations.size(), [&](std::size_t i, TriangularFactor& sum) { sum.add(equations[i].matrix); });
  // Q turns columns and leaves their lengths: the triangular factor has those of the stacked matrix.
  const Matrix6d triangle = factor.triangle();
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> unit(6, 0);
  for (int j = 0; j < 6; ++j) {
    if (!unknown[static_cast<std::size_t>(j)]) continue;
    const double length = triangle.col(j).norm();
    if (length == 0.0) return std::numeric_limits<double>::infinity();
    unit.conservativeResize(6, unit.cols() + 1);
    unit.rightCols<1>() = triangle.col(j) / length;
  }
  if (unit.cols() == 0 || factor.rows() < unit.cols()) return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd values = unit.jacobiSvd().singularValues();
  return values[0] / values[unit.cols() - 1];
}

}  // namespace stiffscope
