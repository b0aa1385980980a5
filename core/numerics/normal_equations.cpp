#include "core/numerics/normal_equations.h"

#include <algorithm>

#include "core/numerics/parallel.h"

namespace stiffscope::numerics {

std::vector<int> columnsInSpanOfEarlier(const Eigen::MatrixXd& jacobian, const std::vector<int>& order) {
  // What is free by choice of frame leaves 1e-7 and, of an unlucky day, 1e-4. What is seen leaves a hundredth and more;
  // with less than a thousandth it would be a thousand times as uncertain as the rest.
  constexpr double kNothingNew = 1e-3;
  std::vector<int> found;
  Eigen::MatrixXd span(jacobian.rows(), static_cast<Eigen::Index>(order.size()));
  Eigen::Index rank = 0;
  for (const int column : order) {
    Eigen::VectorXd rest = jacobian.col(column);
    const double length = rest.norm();
    for (int pass = 0; pass < 2; ++pass) {  // once more against rounding
      rest -= span.leftCols(rank) * (span.leftCols(rank).transpose() * rest);
    }
    if (rest.norm() > kNothingNew * length) {
      span.col(rank++) = rest.normalized();
    } else {
      found.push_back(column);
    }
  }
  return found;
}

namespace {

/// Half of it, of many rows, on all cores.
Eigen::MatrixXd lowerNormal(const Eigen::MatrixXd& equations) {
  constexpr Eigen::Index kColumns = 32;
  const Eigen::Index end = equations.cols();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(end, end);
  onAllCores(static_cast<std::size_t>((end + kColumns - 1) / kColumns), [&](std::size_t block) {
    const Eigen::Index from = kColumns * static_cast<Eigen::Index>(block), count = std::min(kColumns, end - from);
    normal.block(from, from, end - from, count).noalias() =
        equations.rightCols(end - from).transpose() * equations.middleCols(from, count);
  });
  return normal;
}

std::vector<Eigen::Index> columnsWithNumbers(const Eigen::MatrixXd& equations) {
  std::vector<Eigen::Index> found;
  for (Eigen::Index k = 0; k < equations.cols(); ++k) {
    if (!equations.col(k).isZero(0.0)) found.push_back(k);
  }
  return found;
}

}  // namespace

Eigen::MatrixXd normalMatrix(const Eigen::MatrixXd& equations) {
  constexpr Eigen::Index kManyRows = 1000;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(equations.cols(), equations.cols());
  if (equations.rows() < kManyRows) {
    normal.selfadjointView<Eigen::Lower>().rankUpdate(equations.transpose());
  } else {
    // Nearly half of all columns are nothing where no load acts: a third of the work is left without them.
    const std::vector<Eigen::Index> columns = columnsWithNumbers(equations);
    normal(columns, columns) = lowerNormal(equations(Eigen::all, columns));
  }
  normal.triangularView<Eigen::StrictlyUpper>() = normal.transpose();
  return normal;
}

}  // namespace stiffscope::numerics
