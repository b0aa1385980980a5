#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "metrology/remark.h"
#include "metrology/remarks.h"

namespace stiffscope::metrology {

/// What every fit of a shape says beside the shape. Lengths in the unit of the points.
///
/// Without covariances all readings weigh the same, and the covariance of the result is scaled by the
/// residual variance chi2 / degrees_of_freedom; where no degree of freedom is left the shape is exact through
/// its points and nothing tells its uncertainty: then the fit has no covariance. With covariances each
/// residual is weighted by the variance along its own direction, and the result's covariance is the inverse
/// normal matrix, times chi2 / degrees_of_freedom where that exceeds 1.
struct FitQuality {
  bool determined = false;
  Remark reason;               ///< what is not determined, and why
  Remark method;               ///< which distances are minimised, from which start
  double rms = 0.0;            ///< root of the mean square distance of a point from the shape
  double residual_sd = 0.0;    ///< root of the sum of squared distances over degrees_of_freedom; 0 where there are none
  double chi2_per_dof = 0.0;   ///< weighted, where covariances are given; 1 without
  int degrees_of_freedom = 0;  ///< residuals less parameters
};

/// Why `given` readings cannot make a shape that takes `needed`; empty where they are enough, and for none at
/// all, which has a reason of its own (LocalPoints::flaw).
inline Remark tooFewReadings(std::size_t needed, std::size_t given) {
  if (given == 0 || given >= needed) return {};
  return Remark(RemarkId::too_few_readings, needed, given);
}

/// Readings of points in one frame. `covariances` is empty, or one a point, in the square of the points'
/// unit.
struct MeasuredPoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Matrix3d> covariances;
};

/// One-sigma noise of one laser-tracker reading: along the line of sight range_fixed + range_per_m d, in each
/// of the two directions across it angle_fixed + angle_per_m d, d the distance from the station. m, m per m.
struct TrackerNoise {
  double range_fixed = 0.0;
  double range_per_m = 0.0;
  double angle_fixed = 0.0;
  double angle_per_m = 0.0;
  Eigen::Vector3d station = Eigen::Vector3d::Zero();

  /// Covariance (m^2) of a reading at `point`, in the frame in which point and station are given.
  Eigen::Matrix3d covarianceAt(const Eigen::Vector3d& point) const;

  /// The same of an instrument that stood at `from`; where that is not a number, at `station`.
  Eigen::Matrix3d covarianceAt(const Eigen::Vector3d& point, const Eigen::Vector3d& from) const;

  /// The noise of an instrument that stood at `from`; where that is not a number, at `station`.
  TrackerNoise seenFrom(const Eigen::Vector3d& from) const;
};

}  // namespace stiffscope::metrology
