#include "core/identification/stiffness_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace stiffscope {

double StiffnessEstimate::stiffnessSd(int joint) const {
  return std::sqrt(covariance(joint, joint)) / (compliance[joint] * compliance[joint]);
}

std::string StiffnessEstimate::mark(int joint) const {
  if (compliance[joint] < 0.0) return "negative";
  if (stiffnessSd(joint) > std::abs(stiffness(joint))) return "imprecise";
  return {};
}

Matrix6d scatterCovariance(const std::vector<Vector6d>& influences, const JointMask& unknown) {
  const double unknowns = static_cast<double>(std::count(unknown.begin(), unknown.end(), true));
  if (static_cast<double>(influences.size()) < unknowns / 3.0 + 2.0) {
    return Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  Matrix6d sum = Matrix6d::Zero();
  for (const Vector6d& one : influences) sum += one * one.transpose();
  return sum;
}

Vector6d influence(const CaseEquations& equations, const NormalEquations& sum, const Vector6d& compliance,
                   const JointMask& unknown) {
  // With N = L L^T the root acts on six numbers: L^-1 A^T (I - H)^-1/2 r = (I - G)^-1/2 L^-1 A^T r, G = L^-1
  // A^T A L^-T.
  const ScaledNormal scaled = scaledNormal(sum.matrix, unknown);
  const Eigen::LLT<Matrix6d> cholesky(scaled.matrix);
  const Eigen::Matrix<double, 6, Eigen::Dynamic> rows =
      cholesky.matrixL().solve(scaled.scale.asDiagonal() * equations.matrix.transpose());
  const Vector6d pull = rows * (equations.right - equations.matrix * compliance);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> own(rows * rows.transpose());
  constexpr double kMost = 0.95;  // a posture that alone determines a combination has no residual to correct
  const Vector6d root = (1.0 - own.eigenvalues().array().min(kMost)).rsqrt();
  const Vector6d corrected = own.eigenvectors() * root.cwiseProduct(own.eigenvectors().transpose() * pull);
  return scaled.scale.cwiseProduct(cholesky.matrixU().solve(corrected).eval());
}

void describeResiduals(const std::vector<CaseEquations>& equations, StiffnessEstimate& estimate) {
  double sum = 0.0;
  Eigen::Index rows = 0;
  for (const CaseEquations& one : equations) {
    sum += (one.right - one.matrix * estimate.compliance).squaredNorm();
    rows += one.right.size();
  }
  const auto unknowns = std::count(estimate.identifiable.begin(), estimate.identifiable.end(), true);
  estimate.rms_residual = rows > 0 ? std::sqrt(sum / static_cast<double>(rows)) : 0.0;
  estimate.sigma = rows > unknowns ? std::sqrt(sum / static_cast<double>(rows - unknowns)) : 0.0;
}

}  // namespace stiffscope
