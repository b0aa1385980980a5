#include "core/numerics/normal_equations.h"

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
  normal.selfadjointView<Eigen::Lower>().rankUpdate(equations.transpose());
  normal.triangularView<Eigen::StrictlyUpper>() = normal.transpose();
  return normal;
}

}  // namespace stiffscope::numerics
