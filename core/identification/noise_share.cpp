#include "core/identification/noise_share.h"

#include <cmath>

#include "core/frames/measured_axes.h"

namespace stiffscope {

namespace {

constexpr double kMeanNorm = 0.921;  // E|e| / sqrt(trace) for an isotropic normal vector: sqrt(8/(3 pi))

double wristErrorVariance(const Campaign& campaign, const LoadingGeometry& geometry,
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

Eigen::Matrix3d displacementCovariance(const Tracker& tracker, const Eigen::Isometry3d& r0_from_loading,
                                       const TargetMove& move) {
  const TrackerNoise noise = trackerNoise(tracker);
  const Eigen::Isometry3d loading_from_r0 = r0_from_loading.inverse();
  const Eigen::Matrix3d covariance =
      noise.covarianceAt(loading_from_r0 * move.unloaded) / std::max(1, move.unloaded_readings) +
      noise.covarianceAt(loading_from_r0 * move.loaded) / std::max(1, move.loaded_readings);
  return r0_from_loading.linear() * covariance * r0_from_loading.linear().transpose();
}

std::optional<NoiseShare> noiseShare(const Campaign& campaign, const LoadingGeometry& geometry,
                                     const std::vector<LoadCase>& cases, const std::vector<WristMove>& wrist,
                                     const std::vector<double>& radii,
                                     const Eigen::Vector3d& centre_at_zero) {
  if (!campaign.tracker || !geometry.r0_from_loading || cases.empty() || !cases.front().absolute)
    return std::nullopt;
  double wrist_error = 0.0, wrist_sum = 0.0, target_error = 0.0, target_sum = 0.0, trace = 0.0;
  int moves = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!wrist.empty()) {
      wrist_error +=
          kMeanNorm * std::sqrt(wristErrorVariance(campaign, geometry, cases[i], radii, centre_at_zero));
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

}  // namespace stiffscope
