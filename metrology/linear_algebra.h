#pragma once

#include <Eigen/Core>
#include <optional>

// Decompositions of Eigen that many files use, compiled once: each costs a compiler seconds wherever it is named.
namespace stiffscope {

/// Of up to eight unknowns, kept in place. What takes them solves six, a six-axis arm's or a pose's, at fixed size.
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 8, 8>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 8, 1>;

/// Solution of A x = b for a symmetric A, positive or negative semidefinite: LDL^T with pivoting.
Eigen::MatrixXd solveSymmetric(const Eigen::MatrixXd& a, const Eigen::Ref<const Eigen::MatrixXd>& b);

/// Solution of A x = b for a positive definite A: Cholesky, and where that breaks down solveSymmetric.
Eigen::MatrixXd solvePositive(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
SmallVector solvePositive(const SmallMatrix& a, const SmallVector& b);

/// L of A = L L^T for a positive definite A, of which the lower half is read: Cholesky.
Eigen::MatrixXd choleskyLower(const Eigen::MatrixXd& a);

/// Solution of A x = b for an invertible A: LU with partial pivoting.
SmallVector solveLu(const SmallMatrix& a, const SmallVector& b);
SmallMatrix solveLu(const SmallMatrix& a, const SmallMatrix& b);
SmallMatrix inverseOf(const SmallMatrix& a);
Eigen::Matrix<double, 6, 6> inverseOf(const Eigen::Matrix<double, 6, 6>& a);

/// The x of least length among those that minimise |A x - b|: complete orthogonal decomposition. Directions that A
/// stretches by less than `threshold` of what it stretches most count as not seen; without it, those of rounding.
Eigen::VectorXd leastSquaresSolution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                     std::optional<double> threshold = {});
Eigen::MatrixXd pseudoInverse(const Eigen::MatrixXd& a);

/// v^T C^-1 v: the squared distance of v from zero in parts of its covariance C (Mahalanobis).
double mahalanobisSquared(const Eigen::Vector3d& v, const Eigen::Matrix3d& covariance);
double mahalanobisSquared(const Eigen::Matrix<double, 6, 1>& v, const Eigen::Matrix<double, 6, 6>& covariance);
double mahalanobisSquared(const Eigen::VectorXd& v, const Eigen::MatrixXd& covariance);

/// Eigenvalues, ascending, and eigenvectors of a symmetric matrix, whose lower half is read.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  ///< columns of length 1
};
SymmetricEigen symmetricEigen(const Eigen::MatrixXd& a);
Eigen::VectorXd symmetricEigenvalues(const Eigen::MatrixXd& a);

/// J C J^T: the covariance of J x of an x with covariance C (GUM 5.2.2).
Eigen::MatrixXd propagated(const Eigen::MatrixXd& jacobian, const Eigen::Ref<const Eigen::MatrixXd>& covariance);

/// S with S S^T = C of a covariance C, semidefinite or nearly so, by the eigenvectors of its correlation.
Eigen::MatrixXd covarianceRoot(const Eigen::MatrixXd& covariance);

/// Singular values, descending.
Eigen::VectorXd singularValues(const Eigen::MatrixXd& a);

}  // namespace stiffscope
