#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "metrology/measured_points.h"
#include "metrology/remark.h"

namespace stiffscope::metrology {

/// Readings of one reflector on a sphere (m, m^2).
using SpherePoints = MeasuredPoints;

/// Concentric spheres, one a reflector.
struct SphereFit {
  bool determined = false;
  Remark reason;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  std::vector<double> radii;   ///< one a reflector, m
  Eigen::MatrixXd covariance;  ///< of (centre, radii), m^2
  double rms = 0.0;            ///< plain, of the radial residuals, m
  double chi2_per_dof = 0.0;   ///< weighted, where covariances are given; 1 without
  int degrees_of_freedom = 0;
};

/// Least squares on the radial residuals |x - centre| - r_k of the readings of one or more reflectors about
/// one centre, weighted by the variance along the radius where covariances are given. Start: Taubin's common
/// centre. Covariance as in fitAxis. Undetermined with a reason: fewer than four points for a reflector's
/// sphere, points in one plane, or, without covariances, no more readings than unknowns.
SphereFit fitSpheres(const std::vector<SpherePoints>& spheres);

struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

struct FittedSphere : FitQuality {
  static constexpr std::array kParameters{"center_x", "center_y", "center_z", "radius"};
  Sphere sphere;
  std::optional<Eigen::Matrix4d> covariance;  ///< of (centre, radius)
};

/// One sphere by the same least squares, in any unit: 4 degrees of freedom (n - 4 are left). Undetermined:
/// fewer than four places, points in one plane (exactly or within their scatter).
FittedSphere fitSphere(const MeasuredPoints& points);

}  // namespace stiffscope::metrology
