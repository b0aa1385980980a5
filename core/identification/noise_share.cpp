#include "core/identification/noise_share.h"

#include <cmath>

#include "core/frames/joint_axes.h"
#include "core/identification/estimate.h"

namespace stiffscope::identification {

namespace {

/// Covariance between the influences of the postures on one joint, for errors W: with r = (I - H) e and l_p
/// the row of M_p A_p^T, l_p^T [(I - H) W (I - H)^T]_pq l_q. `inner`: A^T W A of all.
InfluenceCovariance covarianceByNoise(const std::vector<PostureGain>& gains, const std::vector<NormalEquations>& normal,
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

std::vector<Matrix6d> reflectorNoise(const campaign::Tracker& tracker, const LoadedArm& arm,
                                     const std::vector<CaseEquations>& equations) {
  std::vector<Matrix6d> noise;
  noise.reserve(arm.cases.size());
  for (std::size_t i = 0; i < arm.cases.size(); ++i) {
    const LoadCase& load_case = arm.cases[i];
    if (!load_case.absolute || !arm.geometry.r0_from_loading) return {};
    Matrix6d sum = Matrix6d::Zero();
    for (std::size_t k = 0; k < load_case.targets.size(); ++k) {
      const Matrix36d rows = equations[i].matrix.middleRows<3>(static_cast<Eigen::Index>(3 * k));
      sum += rows.transpose() * displacementCovariance(tracker, *arm.geometry.r0_from_loading, load_case.targets[k]) *
             rows;
    }
    noise.push_back(sum);
  }
  return noise;
}

void correctForNoise(const std::vector<NormalEquations>& normal, const std::vector<Matrix6d>& noise,
                     StiffnessEstimate& estimate) {
  if (noise.size() != normal.size() || estimate.influences.size() != normal.size()) return;
  const robot::JointMask& unknown = estimate.identifiable;
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

namespace {

constexpr double kMeanNorm = 0.921;  // E|e| / sqrt(trace) for an isotropic normal vector: sqrt(8/(3 pi))

double wristErrorVariance(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                          const LoadCase& load_case, const std::vector<double>& radii,
                          const Eigen::Vector3d& centre_at_zero) {
  constexpr double kStep = 1e-6;  // m
  double trace = 0.0;
  LoadCase moved = load_case;
  const Eigen::Vector3d modelled = modelledWrist(geometry.arm, load_case, centre_at_zero);
  for (std::size_t k = 0; k < load_case.targets.size(); ++k) {
    const Eigen::Vector3d& loaded = load_case.targets[k].loaded;
    Eigen::Matrix3d by_point;
    for (int axis = 0; axis < 3; ++axis) {
      const auto movedBy = [&](double step) {
        moved.targets[k].loaded = loaded + step * Eigen::Vector3d::Unit(axis);
        return wristMove(moved, radii, modelled);
      };
      const auto ahead = movedBy(kStep), behind = movedBy(-kStep);
      moved.targets[k].loaded = loaded;
      if (!ahead || !behind) return 0.0;
      by_point.col(axis) = (ahead->loaded - behind->loaded) / (2.0 * kStep);
    }
    const Eigen::Matrix3d covariance =
        displacementCovariance(*campaign.tracker, *geometry.r0_from_loading, load_case.targets[k]);
    trace += (by_point * covariance * by_point.transpose()).trace();
  }
  return trace;
}

}  // namespace

Eigen::Matrix3d displacementCovariance(const campaign::Tracker& tracker, const Eigen::Isometry3d& r0_from_loading,
                                       const TargetMove& move) {
  const metrology::TrackerNoise noise = frames::trackerNoise(tracker);
  const Eigen::Isometry3d loading_from_r0 = r0_from_loading.inverse();
  const Eigen::Matrix3d covariance =
      noise.covarianceAt(loading_from_r0 * move.unloaded) / std::max(1, move.unloaded_readings) +
      noise.covarianceAt(loading_from_r0 * move.loaded) / std::max(1, move.loaded_readings);
  return r0_from_loading.linear() * covariance * r0_from_loading.linear().transpose();
}

std::optional<NoiseShare> noiseShare(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                     const std::vector<LoadCase>& cases, const std::vector<WristMove>& wrist,
                                     const std::vector<double>& radii, const Eigen::Vector3d& centre_at_zero) {
  if (!campaign.tracker || !geometry.r0_from_loading || cases.empty() || !cases.front().absolute) return std::nullopt;
  double wrist_error = 0.0, wrist_sum = 0.0, target_error = 0.0, target_sum = 0.0, trace = 0.0;
  int moves = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!wrist.empty()) {
      wrist_error += kMeanNorm * std::sqrt(wristErrorVariance(campaign, geometry, cases[i], radii, centre_at_zero));
      wrist_sum += wrist[i].displacement().norm();
    }
    for (const TargetMove& move : cases[i].targets) {
      const double own = displacementCovariance(*campaign.tracker, *geometry.r0_from_loading, move).trace();
      target_error += kMeanNorm * std::sqrt(own);
      trace += own;
      ++moves;
      target_sum += move.displacement().norm();
    }
  }
  NoiseShare share;
  if (wrist_sum > 0.0) share.at_wrist = wrist_error / wrist_sum;
  if (moves > 0) share.per_coordinate = std::sqrt(trace / (3.0 * moves));
  if (target_sum > 0.0) share.at_targets = target_error / target_sum;
  return share;
}

}  // namespace stiffscope::identification
