#include "core/identification/noise_share.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/frames/joint_axes.h"
#include "core/identification/estimate.h"
#include "core/numerics/parallel.h"

namespace stiffscope::identification {

namespace {

/// Covariance between the influences of the postures on one joint, for errors W: with r = (I - H) e and l_p
/// the row of M_p A_p^T, l_p^T [(I - H) W (I - H)^T]_pq l_q. `inner`: A^T W A of all.
InfluenceCovariance covarianceByNoise(const GainOfEach& gains, const std::vector<NormalEquations>& normal,
                                      const std::vector<JointMatrix>& noise, const JointMatrix& inverse,
                                      const JointMatrix& inner, int joint) {
  const auto n = static_cast<Eigen::Index>(gains.size());
  const Eigen::Index joints = inverse.rows(), rank = 2 * joints;
  InfluenceCovariance covariance{Eigen::VectorXd(n), Eigen::MatrixXd(rank, n), Eigen::MatrixXd::Zero(rank, rank)};
  for (Eigen::Index p = 0; p < n; ++p) {
    const auto at = static_cast<std::size_t>(p);
    const JointVector row = gains[at].row(joint).transpose(), by_noise = noise[at].lazyProduct(row),
                      by_rest = normal[at].matrix.lazyProduct(row);
    covariance.through.col(p) << inverse.lazyProduct(by_rest), by_noise;
    covariance.own[p] = row.dot(by_noise);
  }
  covariance.middle.topLeftCorner(joints, joints) = inner;
  covariance.middle.topRightCorner(joints, joints) = -JointMatrix::Identity(joints, joints);
  covariance.middle.bottomLeftCorner(joints, joints) = -JointMatrix::Identity(joints, joints);
  return covariance;
}

}  // namespace

std::vector<JointMatrix> reflectorNoise(const campaign::Tracker& tracker, const LoadedArm& arm,
                                        const std::vector<CaseEquations>& equations) {
  if (!arm.geometry.r0_from_loading ||
      std::any_of(arm.cases.begin(), arm.cases.end(), [](const LoadCase& load_case) { return !load_case.absolute; }))
    return {};
  std::vector<JointMatrix> noise(arm.cases.size());
  numerics::smallWorkOnAllCores(arm.cases.size(), [&](std::size_t i) {
    const LoadCase& load_case = arm.cases[i];
    const Eigen::Index joints = equations[i].matrix.cols();
    JointMatrix sum = JointMatrix::Zero(joints, joints);
    for (std::size_t k = 0; k < load_case.targets.size(); ++k) {
      const PointJacobian rows = equations[i].matrix.middleRows<3>(static_cast<Eigen::Index>(3 * k));
      sum += rows.transpose() * displacementCovariance(tracker, *arm.geometry.r0_from_loading, load_case.targets[k]) *
             rows;
    }
    noise[i] = sum;
  });
  return noise;
}

void correctForNoise(const std::vector<NormalEquations>& normal, const std::vector<JointMatrix>& noise,
                     StiffnessEstimate& estimate) {
  if (noise.size() != normal.size() || estimate.influences.size() != normal.size()) return;
  const robot::JointMask& unknown = estimate.identifiable;
  const NormalEquations sum = sumOf(normal);
  const auto joints = static_cast<Eigen::Index>(unknown.size());
  JointMatrix inner = JointMatrix::Zero(joints, joints);
  for (const JointMatrix& one : noise) inner += one;
  const PostureGains gain(sum, unknown);
  GainOfEach gains(joints, normal.size());
  numerics::smallWorkOnAllCores(normal.size(), [&](std::size_t p) { gains[p] = gain.of(normal[p].matrix); });
  const JointMatrix inverse = inverseNormal(sum, unknown);
  const JointMatrix truth = inverse * inner * inverse;
  JointVector factor = JointVector::Zero(joints), dof = factor;
  robot::JointMask known(unknown.size(), true);
  numerics::onAllCores(
      unknown.size(),
      [&](std::size_t joint) {
        if (!unknown[joint]) return;
        const int j = static_cast<int>(joint);
        const InfluenceCovariance covariance = covarianceByNoise(gains, normal, noise, inverse, inner, j);
        known[joint] = covariance.trace() > 0.0;
        if (!known[joint]) return;
        factor[j] = std::sqrt(truth(j, j) / covariance.trace());
        dof[j] = matchedDof(covariance);
      },
      normal.size() >= numerics::kWorthThreads);
  if (std::find(known.begin(), known.end(), false) != known.end()) return;
  std::vector<JointVector> influences = estimate.influences;
  for (JointVector& one : influences) one = one.cwiseProduct(factor);
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

/// Lengths of errors and displacements, m, and what the reflectors' variances add up to, m^2.
struct NoiseSums {
  double wrist_error = 0.0, wrist = 0.0, target_error = 0.0, targets = 0.0, trace = 0.0, moves = 0.0;

  NoiseSums& operator+=(const NoiseSums& other) {
    wrist_error += other.wrist_error;
    wrist += other.wrist;
    target_error += other.target_error;
    targets += other.targets;
    trace += other.trace;
    moves += other.moves;
    return *this;
  }
};

}  // namespace

Eigen::Matrix3d displacementCovariance(const campaign::Tracker& tracker, const Eigen::Isometry3d& r0_from_loading,
                                       const TargetMove& move) {
  const Eigen::Isometry3d loading_from_r0 = r0_from_loading.inverse();
  const metrology::TrackerNoise noise = frames::trackerNoise(tracker).seenFrom(loading_from_r0 * move.from);
  const Eigen::Matrix3d covariance =
      noise.covarianceAt(loading_from_r0 * move.unloaded) / std::max(1, move.unloaded_readings) +
      noise.covarianceAt(loading_from_r0 * move.loaded) / std::max(1, move.loaded_readings);
  return r0_from_loading.linear() * covariance * r0_from_loading.linear().transpose();
}

std::optional<NoiseShare> noiseShare(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                     const std::vector<LoadCase>& cases, const std::vector<WristMove>& wrist,
                                     const std::vector<double>& radii, const Eigen::Vector3d& centre_at_zero) {
  if (!campaign.tracker || !geometry.r0_from_loading || cases.empty() || !cases.front().absolute) return std::nullopt;
  const auto sums = numerics::sumInBlocks<NoiseSums>(
      cases.size(),
      [&](std::size_t i, NoiseSums& sum) {
        if (!wrist.empty()) {
          sum.wrist_error +=
              kMeanNorm * std::sqrt(wristErrorVariance(campaign, geometry, cases[i], radii, centre_at_zero));
          sum.wrist += wrist[i].displacement().norm();
        }
        for (const TargetMove& move : cases[i].targets) {
          const double own = displacementCovariance(*campaign.tracker, *geometry.r0_from_loading, move).trace();
          sum.target_error += kMeanNorm * std::sqrt(own);
          sum.trace += own;
          sum.moves += 1.0;
          sum.targets += move.displacement().norm();
        }
      },
      4);
  NoiseShare share;
  if (sums.wrist > 0.0) share.at_wrist = sums.wrist_error / sums.wrist;
  if (sums.moves > 0.0) share.per_coordinate = std::sqrt(sums.trace / (3.0 * sums.moves));
  if (sums.targets > 0.0) share.at_targets = sums.target_error / sums.targets;
  return share;
}

}  // namespace stiffscope::identification
