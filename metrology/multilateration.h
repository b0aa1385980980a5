#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace stiffscope::metrology {

/// A distance measured from a known point.
struct MeasuredDistance {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  double distance = 0.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of `from`, squared unit of the points
  double sd = 0.0;                                       ///< of the distance
};

/// A place found from distances, in the unit of the points.
struct Multilateration {
  bool determined = false;
  std::string reason;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// The place on the other side that the distances allow as well: always with three, else where all points
  /// lie (nearly) in one plane. `point` is then the one nearer to what was expected.
  std::optional<Eigen::Vector3d> mirror;
  double rms = 0.0;  ///< of the differences between distances
  double chi2_per_dof = 0.0;
  int degrees_of_freedom = 0;
};

/// Least squares of |x - p_i| - d_i over the place x, weighted by sd_i^2 + e_i' C_i e_i, e_i the direction to
/// x; all equal where every sd and covariance is zero. Start: the closed form (trilateration.h) of the three
/// points whose triangle is largest; both its roots are refined, and the smaller sum is taken, or where the
/// sums do not tell them apart at 95 % the root nearer to `expected`, which without one is undetermined.
/// Covariance as in FitQuality; with three distances and no sd there is nothing to tell it by, and it is
/// undetermined. Undetermined: fewer than three points, points on one line, a place in the plane of all
/// points (its height across the plane is then free).
Multilateration multilaterate(const std::vector<MeasuredDistance>& distances,
                              const std::optional<Eigen::Vector3d>& expected = std::nullopt);

}  // namespace stiffscope::metrology
