#include "core/identification/stiffness_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identification/influence_covariance.h"
#include "core/identification/posture_influence.h"

namespace stiffscope {

double StiffnessEstimate::stiffnessSd(int joint) const {
  return std::sqrt(covariance(joint, joint)) / (compliance[joint] * compliance[joint]);
}

double StiffnessEstimate::dof(int joint) const {
  const double scatter = parts.scatter(joint, joint);
  if (scatter <= 0.0) return scatter_dof[joint];
  const double ratio = covariance(joint, joint) / scatter;
  return scatter_dof[joint] * ratio * ratio;
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

void setScatter(std::vector<Vector6d> influences, const Vector6d& dof, StiffnessEstimate& estimate) {
  estimate.parts = {};
  estimate.parts.scatter = scatterCovariance(influences, estimate.identifiable);
  estimate.covariance = estimate.parts.scatter;
  estimate.scatter_dof = dof;
  estimate.influences = std::move(influences);
}

void setScatterOfOneStage(const std::vector<NormalEquations>& normal, const NormalEquations& sum,
                          StiffnessEstimate& estimate) {
  const PostureGains gain(sum, estimate.identifiable);
  std::vector<PostureGain> gains;
  std::vector<Vector6d> influences;
  gains.reserve(normal.size());
  influences.reserve(normal.size());
  for (const NormalEquations& one : normal) {
    gains.push_back(gain.of(one.matrix));
    influences.push_back(gains.back() * (one.right - one.matrix * estimate.compliance));
  }
  const Matrix6d inverse = inverseNormal(sum, estimate.identifiable);
  Vector6d dof = Vector6d::Zero();
  for (int j = 0; j < 6; ++j) {
    if (estimate.identifiable[static_cast<std::size_t>(j)]) {
      dof[j] = matchedDof(influenceCovariance(gains, normal, inverse, j));
    }
  }
  setScatter(std::move(influences), dof, estimate);
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
