#pragma once

#include <Eigen/Core>

namespace stiffscope {

/// [A y]^T [A y] of whitened equations; half of it computed, the rest mirrored.
inline Eigen::MatrixXd normalMatrix(const Eigen::MatrixXd& equations) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(equations.cols(), equations.cols());
  normal.selfadjointView<Eigen::Lower>().rankUpdate(equations.transpose());
  normal.triangularView<Eigen::StrictlyUpper>() = normal.transpose();
  return normal;
}

}  // namespace stiffscope
