#include "core/identification/working_noise.h"

#include <cmath>

#include "core/identification/noise_share.h"
#include "core/identification/influence_covariance.h"
#include "core/identification/posture_influence.h"

namespace stiffscope {

namespace {

/// Covariance between the influences of the postures on one joint, for errors W: with r = (I - H) e,
/// l_p^T [(I - H) W (I - H)^T]_pq l_q.
InfluenceCovariance covarianceByNoise(const std::vector<PostureGain>& gains, const std::vector<CaseEquations>& equations,
                                  const std::vector<Eigen::MatrixXd>& noise, const Matrix6d& inverse,
                                  const Matrix6d& inner, int joint) {
  const auto n = static_cast<Eigen::Index>(gains.size());
  InfluenceCovariance covariance{Eigen::VectorXd(n), Eigen::MatrixXd(12, n), Eigen::MatrixXd::Zero(12, 12)};
  for (Eigen::Index p = 0; p < n; ++p) {
    const auto at = static_cast<std::size_t>(p);
    const Eigen::VectorXd row = gains[at].row(joint).transpose();
    const Eigen::VectorXd by_noise = noise[at] * row;
    covariance.through.col(p) << inverse * equations[at].matrix.transpose() * row, equations[at].matrix.transpose() * by_noise;
    covariance.own[p] = row.dot(by_noise);
  }
  covariance.middle.topLeftCorner<6, 6>() = inner;
  covariance.middle.topRightCorner<6, 6>() = -Matrix6d::Identity();
  covariance.middle.bottomLeftCorner<6, 6>() = -Matrix6d::Identity();
  return covariance;
}

}  // namespace

std::vector<Eigen::MatrixXd> reflectorNoise(const Tracker& tracker, const LoadedArm& arm) {
  std::vector<Eigen::MatrixXd> noise;
  for (const LoadCase& load_case : arm.cases) {
    if (!load_case.absolute || !arm.geometry.r0_from_loading) return {};
    const auto rows = static_cast<Eigen::Index>(3 * load_case.targets.size());
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(rows, rows);
    for (Eigen::Index k = 0; 3 * k < rows; ++k) {
      block.block<3, 3>(3 * k, 3 * k) = displacementCovariance(tracker, *arm.geometry.r0_from_loading,
                                                               load_case.targets[static_cast<std::size_t>(k)]);
    }
    noise.push_back(block);
  }
  return noise;
}

void correctForNoise(const std::vector<CaseEquations>& equations, const std::vector<Eigen::MatrixXd>& noise,
                     StiffnessEstimate& estimate) {
  if (noise.size() != equations.size() || estimate.influences.size() != equations.size()) return;
  const JointMask& unknown = estimate.identifiable;
  NormalEquations sum;
  Matrix6d inner = Matrix6d::Zero();  // A^T W A
  for (std::size_t p = 0; p < equations.size(); ++p) {
    sum += normalEquations(equations[p]);
    inner += equations[p].matrix.transpose() * noise[p] * equations[p].matrix;
  }
  std::vector<PostureGain> gains;
  for (const CaseEquations& one : equations) gains.push_back(correctedGain(one, sum, unknown));
  const Matrix6d inverse = inverseNormal(sum, unknown);
  const Matrix6d truth = inverse * inner * inverse;
  Vector6d factor = Vector6d::Zero(), dof = Vector6d::Zero();
  for (int j = 0; j < 6; ++j) {
    if (!unknown[static_cast<std::size_t>(j)]) continue;
    const InfluenceCovariance covariance = covarianceByNoise(gains, equations, noise, inverse, inner, j);
    if (!(covariance.trace() > 0.0)) return;
    factor[j] = std::sqrt(truth(j, j) / covariance.trace());
    dof[j] = matchedDof(covariance);
  }
  std::vector<Vector6d> influences = estimate.influences;
  for (Vector6d& one : influences) one = one.cwiseProduct(factor);
  setScatter(std::move(influences), dof, estimate);
}

}  // namespace stiffscope
