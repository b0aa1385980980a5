#include "core/numerics/normal_equations.h"

#include <algorithm>

#include "core/numerics/parallel.h"

namespace stiffscope::numerics {

std::vector<int> columnsInSpanOfEarlier(const Eigen::MatrixXd& jacobian, const std::vector<int>& order) {
  constexpr double kNothingNew = 1e-5;
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

Eigen::MatrixXd normalMatrix(const Eigen::MatrixXd& equations) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(equations.cols(), equations.cols());
  constexpr Eigen::Index kManyRows = 1000, kColumns = 32;
  if (equations.rows() < kManyRows) {
    normal.selfadjointView<Eigen::Lower>().rankUpdate(equations.transpose());
  } else {
    const Eigen::Index end = equations.cols();
    onAllCores(static_cast<std::size_t>((end + kColumns - 1) / kColumns), [&](std::size_t block) {
      const Eigen::Index from = kColumns * static_cast<Eigen::Index>(block), count = std::min(kColumns, end - from);
      normal.block(from, from, end - from, count).noalias() =
          equations.rightCols(end - from).transpose() * equations.middleCols(from, count);
    });
  }
  normal.triangularView<Eigen::StrictlyUpper>() = normal.transpose();
  return normal;
}

}  // namespace stiffscope::numerics
