#include "core/identification/working_noise.h"

#include <cmath>

#include "core/identification/influence_covariance.h"
#include "core/identification/noise_share.h"
#include "core/identification/posture_influence.h"

namespace stiffscope {

namespace {

/// Covariance between the influences of the postures on one joint, for errors W: with r = (I - H) e and l_p
/// the row of M_p A_p^T, l_p^T [(I - H) W (I - H)^T]_pq l_q. `inner`: A^T W A of all.
InfluenceCovariance covarianceByNoise(const std::vector<PostureGain>& gains,
                                      const std::vector<NormalEquations>& normal,
                                      const std::vector<Matrix6d>& noise, const Matrix6d& inverse,
                                      const Matrix6d& inner, int joint) {
  const auto n = static_cast<Eigen::Index>(gains.size());
  InfluenceCovariance covariance{Eigen::VectorXd(n), Eigen::MatrixXd(12, n), Eigen::MatrixXd::Zero(12, 12)};
  for (Eigen::Index p = 0; p < n; ++p) {
    const auto at = static_cast<std::size_t>(p);
    const Vector6d row = gains[at].row(joint).transpose(), by_noise = noise[at] * row;
    covariance.through.col(p) << inverse * (normal[at].matrix * row), by_noise;
    covariance.own[p] = row.dot(by_noise);
  }
  covariance.middle.topLeftCorner<6, 6>() = inner;
  covariance.middle.topRightCorner<6, 6>() = -Matrix6d::Identity();
  covariance.middle.bottomLeftCorner<6, 6>() = -Matrix6d::Identity();
  return covariance;
}

}  // namespace

std::vector<Matrix6d> reflectorNoise(const Tracker& tracker, const LoadedArm& arm,
                                     const std::vector<CaseEquations>& equations) {
  std::vector<Matrix6d> noise;
  noise.reserve(arm.cases.size());
  for (std::size_t i = 0; i < arm.cases.size(); ++i) {
    const LoadCase& load_case = arm.cases[i];
    if (!load_case.absolute || !arm.geometry.r0_from_loading) return {};
    Matrix6d sum = Matrix6d::Zero();
    for (std::size_t k = 0; k < load_case.targets.size(); ++k) {
      const Matrix36d rows = equations[i].matrix.middleRows<3>(static_cast<Eigen::Index>(3 * k));
      sum += rows.transpose() *
             displacementCovariance(tracker, *arm.geometry.r0_from_loading, load_case.targets[k]) * rows;
    }
    noise.push_back(sum);
  }
  return noise;
}

void correctForNoise(const std::vector<NormalEquations>& normal, const std::vector<Matrix6d>& noise,
                     StiffnessEstimate& estimate) {
  if (noise.size() != normal.size() || estimate.influences.size() != normal.size()) return;
  const JointMask& unknown = estimate.identifiable;
  const NormalEquations sum = sumOf(normal);
  Matrix6d inner = Matrix6d::Zero();
  for (const Matrix6d& one : noise) inner += one;
  const PostureGains gain(sum, unknown);
  std::vector<PostureGain> gains;
  gains.reserve(normal.size());
  for (const NormalEquations& one : normal) gains.push_back(gain.of(one.matrix));
  const Matrix6d inverse = inverseNormal(sum, unknown);
  const Matrix6d truth = inverse * inner * inverse;
  Vector6d factor = Vector6d::Zero(), dof = Vector6d::Zero();
  for (int j = 0; j < 6; ++j) {
    if (!unknown[static_cast<std::size_t>(j)]) continue;
    const InfluenceCovariance covariance = covarianceByNoise(gains, normal, noise, inverse, inner, j);
    if (!(covariance.trace() > 0.0)) return;
    factor[j] = std::sqrt(truth(j, j) / covariance.trace());
    dof[j] = matchedDof(covariance);
  }
  std::vector<Vector6d> influences = estimate.influences;
  for (Vector6d& one : influences) one = one.cwiseProduct(factor);
  setScatter(std::move(influences), dof, estimate);
}

}  // namespace stiffscope
