#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identification/posture_influence.h"

namespace stiffscope {

/// Covariance between the influences of n postures on one joint, C = diag(own) + through^T middle through. What ties
/// postures together is the few parameters they share, so C is a diagonal and a matrix of rank r, 12 at most; as n x n
/// numbers it would cost n^2 in memory and its eigenvalues n^3.
struct InfluenceCovariance {
  Eigen::VectorXd own;      ///< n
  Eigen::MatrixXd through;  ///< r x n
  Eigen::MatrixXd middle;   ///< r x r, symmetric

  double trace() const;
  /// Sum of the squares of all entries of C, in n r^2.
  double squaredNorm() const;
  /// The entries of C between these postures.
  Eigen::MatrixXd between(const std::vector<Eigen::Index>& postures) const;
};

/// a first + b second, of the same postures.
InfluenceCovariance combined(double a, const InfluenceCovariance& first, double b, const InfluenceCovariance& second);

/// If all residuals came from errors that are independent and have variance 1: with l_p the row of M_p A_p^T (PostureGain)
/// and U_p = A_p^T l_p, C_pq = delta_pq |l_p|^2 - U_p^T N^-1 U_q. `normal`: A_p^T A_p.
InfluenceCovariance influenceCovariance(const std::vector<PostureGain>& gains, const std::vector<NormalEquations>& normal,
                                        const Matrix6d& inverse, int joint);

/// Degrees of freedom of Student's t with the same factor at the stated coverage as a sum of squares of influences with
/// that covariance. Up to 64 postures by the eigenvalues of C. Of more, the 64 with the largest influence are taken so and
/// the others, each below a 64th of the sum, as equal weights of the same trace, C's squares kept: for them only the second
/// moment matters.
double matchedDof(const InfluenceCovariance& covariance);

}  // namespace stiffscope
