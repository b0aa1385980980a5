#include "core/identification/stiffness_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identification/influence_covariance.h"
#include "core/identification/posture_influence.h"
#include "core/parallel/sum_in_blocks.h"

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
  std::vector<PostureGain> gains(normal.size());
  std::vector<Vector6d> influences(normal.size());
  smallWorkOnAllCores(normal.size(), [&](std::size_t p) {
    gains[p] = gain.of(normal[p].matrix);
    influences[p] = gains[p] * (normal[p].right - normal[p].matrix * estimate.compliance);
  });
  const Matrix6d inverse = inverseNormal(sum, estimate.identifiable);
  Vector6d dof = Vector6d::Zero();
  onAllCores(6, [&](std::size_t j) {
    if (!estimate.identifiable[j]) return;
    const auto joint = static_cast<int>(j);
    dof[joint] = matchedDof(influenceCovariance(gains, normal, inverse, joint));
  }, normal.size() >= kWorthThreads);
  setScatter(std::move(influences), dof, estimate);
}

void describeResiduals(const std::vector<CaseEquations>& equations, StiffnessEstimate& estimate) {
  const double sum = sumInBlocks<double>(equations.size(), [&](std::size_t i, double& squares) {
    squares += (equations[i].right - equations[i].matrix * estimate.compliance).squaredNorm();
  });
  Eigen::Index rows = 0;
  for (const CaseEquations& one : equations) rows += one.right.size();
  const auto unknowns = std::count(estimate.identifiable.begin(), estimate.identifiable.end(), true);
  estimate.rms_residual = rows > 0 ? std::sqrt(sum / static_cast<double>(rows)) : 0.0;
  estimate.sigma = rows > unknowns ? std::sqrt(sum / static_cast<double>(rows - unknowns)) : 0.0;
}

}  // namespace stiffscope
