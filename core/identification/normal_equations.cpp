#include "core/identification/normal_equations.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace stiffscope {

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  matrix += other.matrix;
  right += other.right;
  return *this;
}

NormalEquations normalEquations(const CaseEquations& equations) {
  return {equations.matrix.transpose() * equations.matrix, equations.matrix.transpose() * equations.right};
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
  Eigen::Index rows = 0;
  for (const CaseEquations& one : equations) rows += one.matrix.rows();
  Eigen::MatrixXd stacked(rows, 6);
  rows = 0;
  for (const CaseEquations& one : equations) {
    stacked.middleRows(rows, one.matrix.rows()) = one.matrix;
    rows += one.matrix.rows();
  }
  Eigen::Index columns = 0;
  for (int j = 0; j < 6; ++j) {
    if (!unknown[static_cast<std::size_t>(j)]) continue;
    const double length = stacked.col(j).norm();
    if (length == 0.0) return std::numeric_limits<double>::infinity();
    const Eigen::VectorXd column = stacked.col(j) / length;
    stacked.col(columns++) = column;
  }
  if (columns == 0 || rows < columns) return std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd reduced =
      stacked.leftCols(columns).householderQr().matrixQR().topRows(columns).triangularView<Eigen::Upper>();
  const Eigen::VectorXd values = reduced.jacobiSvd().singularValues();
  return values[0] / values[columns - 1];
}

}  // namespace stiffscope
