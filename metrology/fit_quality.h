#pragma once

#include <string>

namespace stiffscope {

/// What every fit of a shape says beside the shape. Lengths in the unit of the points.
///
/// Without covariances all readings weigh the same, and the covariance of the result is scaled by the
/// residual variance chi2 / degrees_of_freedom; where no degree of freedom is left the shape is exact through
/// its points and nothing tells its uncertainty: then the fit has no covariance. With covariances each
/// residual is weighted by the variance along its own direction, and the result's covariance is the inverse
/// normal matrix, times chi2 / degrees_of_freedom where that exceeds 1.
struct FitQuality {
  bool determined = false;
  std::string reason;       ///< what is not determined, and why
  const char* method = "";  ///< which distances are minimised, from which start
  double rms = 0.0;         ///< root of the mean square distance of a point from the shape
  double residual_sd =
      0.0;  ///< root of the sum of squared distances over degrees_of_freedom; 0 where there are none
  double chi2_per_dof = 0.0;   ///< weighted, where covariances are given; 1 without
  int degrees_of_freedom = 0;  ///< residuals less parameters
};

}  // namespace stiffscope
