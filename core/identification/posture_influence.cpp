#include "core/identification/posture_influence.h"

#include <Eigen/Dense>

namespace stiffscope {

PostureGain correctedGain(const CaseEquations& equations, const NormalEquations& sum, const JointMask& unknown) {
  // With N = L L^T the root acts on six numbers: L^-1 A^T (I - H)^-1/2 r = (I - G)^-1/2 L^-1 A^T r, G = L^-1
  // A^T A L^-T.
  const ScaledNormal scaled = scaledNormal(sum.matrix, unknown);
  const Eigen::LLT<Matrix6d> cholesky(scaled.matrix);
  const PostureGain rows = cholesky.matrixL().solve(scaled.scale.asDiagonal() * equations.matrix.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix6d> own(rows * rows.transpose());
  constexpr double kMost = 0.95;  // a posture that alone determines a combination has no residual to correct
  const Vector6d root = (1.0 - own.eigenvalues().array().min(kMost)).rsqrt();
  const Matrix6d corrected = own.eigenvectors() * root.asDiagonal() * own.eigenvectors().transpose();
  return scaled.scale.asDiagonal() * cholesky.matrixU().solve((corrected * rows).eval());
}

Matrix6d inverseNormal(const NormalEquations& sum, const JointMask& unknown) {
  const ScaledNormal scaled = scaledNormal(sum.matrix, unknown);
  return scaled.scale.asDiagonal() * scaled.matrix.inverse() * scaled.scale.asDiagonal();
}

double satterthwaite(const Eigen::MatrixXd& covariance) {
  const double trace = covariance.trace();
  return trace > 0.0 ? trace * trace / covariance.squaredNorm() : 0.0;
}

std::vector<CaseEquations> byPosture(const std::vector<CaseEquations>& equations) {
  std::vector<CaseEquations> joined;
  for (const CaseEquations& one : equations) {
    if (joined.empty() || one.posture < 0 || joined.back().posture != one.posture) {
      joined.push_back(one);
      continue;
    }
    CaseEquations& last = joined.back();
    const Eigen::Index had = last.right.size(), more = one.right.size();
    last.matrix.conservativeResize(had + more, 6);
    last.right.conservativeResize(had + more);
    last.matrix.bottomRows(more) = one.matrix;
    last.right.tail(more) = one.right;
  }
  return joined;
}

}  // namespace stiffscope
