#include "metrology/linear_algebra.h"

#include <Eigen/Dense>

namespace stiffscope {

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Vector6d solveSymmetric6(const Matrix6d& a, const Vector6d& b) { return a.ldlt().solve(b); }

}  // namespace

Eigen::MatrixXd solveSymmetric(const Eigen::MatrixXd& a, const Eigen::Ref<const Eigen::MatrixXd>& b) {
  return a.ldlt().solve(b);
}

Eigen::MatrixXd solvePositive(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(a);
  if (cholesky.info() != Eigen::Success) return solveSymmetric(a, b);
  return cholesky.solve(b);
}

SmallVector solvePositive(const SmallMatrix& a, const SmallVector& b) {
  if (a.rows() == 6) {
    const Eigen::LLT<Matrix6d> cholesky{Matrix6d(a)};
    if (cholesky.info() != Eigen::Success) return solveSymmetric6(a, b);
    const Vector6d x = cholesky.solve(Vector6d(b));  // at fixed size to its end
    return x;
  }
  const Eigen::LLT<SmallMatrix> cholesky(a);
  if (cholesky.info() != Eigen::Success) return a.ldlt().solve(b);
  return cholesky.solve(b);
}

Eigen::MatrixXd choleskyLower(const Eigen::MatrixXd& a) { return a.llt().matrixL(); }

SmallVector solveLu(const SmallMatrix& a, const SmallVector& b) {
  if (a.rows() == 6) {
    const Vector6d x = Matrix6d(a).partialPivLu().solve(Vector6d(b));
    return x;
  }
  return a.partialPivLu().solve(b);
}

SmallMatrix solveLu(const SmallMatrix& a, const SmallMatrix& b) {
  if (a.rows() == 6 && b.cols() == 6) {
    const Matrix6d x = Matrix6d(a).partialPivLu().solve(Matrix6d(b));
    return x;
  }
  return a.partialPivLu().solve(b);
}

SmallMatrix inverseOf(const SmallMatrix& a) {
  if (a.rows() == 6) return inverseOf(Matrix6d(a));
  return a.inverse();
}

Matrix6d inverseOf(const Matrix6d& a) { return a.inverse(); }

Eigen::VectorXd leastSquaresSolution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                     std::optional<double> threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  if (threshold) decomposition.setThreshold(*threshold);
  decomposition.compute(a);
  return decomposition.solve(b);
}

Eigen::MatrixXd pseudoInverse(const Eigen::MatrixXd& a) { return a.completeOrthogonalDecomposition().pseudoInverse(); }

double mahalanobisSquared(const Eigen::Vector3d& v, const Eigen::Matrix3d& covariance) {
  return v.dot(covariance.ldlt().solve(v));
}

double mahalanobisSquared(const Vector6d& v, const Matrix6d& covariance) {
  return v.dot(solveSymmetric6(covariance, v));
}

double mahalanobisSquared(const Eigen::VectorXd& v, const Eigen::MatrixXd& covariance) {
  return v.dot(Eigen::VectorXd(covariance.ldlt().solve(v)));
}

SymmetricEigen symmetricEigen(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd symmetricEigenvalues(const Eigen::MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::MatrixXd propagated(const Eigen::MatrixXd& jacobian, const Eigen::Ref<const Eigen::MatrixXd>& covariance) {
  return jacobian * covariance * jacobian.transpose();
}

Eigen::MatrixXd covarianceRoot(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd sd = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd inverse = sd.unaryExpr([](double d) { return d > 0.0 ? 1.0 / d : 0.0; });
  const SymmetricEigen own = symmetricEigen(inverse.asDiagonal() * covariance * inverse.asDiagonal());
  return sd.asDiagonal() * own.vectors * own.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

Eigen::VectorXd singularValues(const Eigen::MatrixXd& a) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(a).singularValues();
}

}  // namespace stiffscope
