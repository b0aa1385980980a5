#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "metrology/remark.h"

namespace stiffscope::metrology {

struct RigidRegistration {
  bool determined = false;
  Remark reason;
  Eigen::Isometry3d to_from_source = Eigen::Isometry3d::Identity();
  double rms = 0.0;  ///< per coordinate, m
};

/// The proper rigid motion (never a reflection) that brings `source` onto `to` in least squares, point by
/// point. Undetermined: fewer than three points, or points on one line.
RigidRegistration registerRigid(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& to);

/// Whether points leave the line through them by less than a hundredth of their length along it, fewer than three
/// always: the turn about it is then worth nothing in readings, although a registration without noise would find it.
bool nearlyOnOneLine(const std::vector<Eigen::Vector3d>& points);

struct WeightedRegistration : RigidRegistration {
  /// Covariance of a small motion after the found one, in the `to` frame: rotation vector (rad) about the mean of `to`,
  /// then shift (m).
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< the mean of `to`, about which that rotation is
  double chi2_per_dof = 0.0;
  int degrees_of_freedom = 0;
};

/// The same with one covariance a pair: that of the difference to_i - R source_i, in the `to` frame (m^2).
/// Least sum of the squared differences weighted by their inverse covariances, Gauss-Newton from the
/// unweighted motion. Covariance as in FitQuality. Undetermined as above, and with covariances that are not
/// one a pair and positive definite.
WeightedRegistration registerRigid(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& to,
                                   const std::vector<Eigen::Matrix3d>& covariances);

}  // namespace stiffscope::metrology
