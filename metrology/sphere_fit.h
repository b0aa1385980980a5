#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace stiffscope {

/// Readings of one reflector on a sphere. `covariances` is empty, or one a point (m^2).
struct SpherePoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Matrix3d> covariances;
};

/// Concentric spheres, one a reflector.
struct SphereFit {
  bool determined = false;
  std::string reason;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  std::vector<double> radii;          ///< one a reflector, m
  Eigen::MatrixXd covariance;         ///< of (centre, radii), m^2
  double rms = 0.0;                   ///< plain, of the radial residuals, m
  double chi2_per_dof = 0.0;          ///< weighted, where covariances are given; 1 without
  int degrees_of_freedom = 0;
};

/// Least squares on the radial residuals |x - centre| - r_k of the readings of one or more reflectors about one
/// centre, weighted by the variance along the radius where covariances are given. Start: the linear (algebraic)
/// common centre. Covariance as in fitAxis. Undetermined with a reason: fewer than four points for a reflector's
/// sphere, points in one plane, or, without covariances, no more readings than unknowns.
SphereFit fitSpheres(const std::vector<SpherePoints>& spheres);

}  // namespace stiffscope
