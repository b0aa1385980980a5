#include "core/identification/stiffness_estimate.h"

#include <algorithm>
#include <cmath>

namespace stiffscope {

double StiffnessEstimate::stiffnessSd(int joint) const {
  return std::sqrt(covariance(joint, joint)) / (compliance[joint] * compliance[joint]);
}

std::string StiffnessEstimate::mark(int joint) const {
  if (compliance[joint] < 0.0) return "negative";
  if (stiffnessSd(joint) > std::abs(stiffness(joint))) return "imprecise";
  return {};
}

Matrix6d scatterCovariance(const std::vector<Vector6d>& influences, int unknowns) {
  Matrix6d sum = Matrix6d::Zero();
  for (const Vector6d& one : influences) sum += one * one.transpose();
  const double n = static_cast<double>(influences.size());
  const double spent = std::max(1.0, unknowns / 3.0);
  return n > spent ? Matrix6d(sum * n / (n - spent)) : sum;
}

Vector6d influence(const CaseEquations& equations, const NormalEquations& sum, const Vector6d& compliance,
                   const JointMask& unknown) {
  const NormalEquations own{sum.matrix, equations.matrix.transpose() * (equations.right - equations.matrix * compliance)};
  return solveNormal(own, unknown);
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
