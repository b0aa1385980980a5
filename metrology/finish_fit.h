#pragma once

#include <cmath>

#include "metrology/fit_quality.h"
#include "metrology/least_squares.h"

namespace stiffscope {

/// Fills in what the residuals say; false, with the reason, where the estimate is not determined.
template <class Model, int Groups>
bool describeQuality(const Estimate<Model, Groups>& estimate, const LocalPoints& local, FitQuality& quality) {
  quality.degrees_of_freedom = estimate.degreesOfFreedom();
  if (!estimate.determined) {
    quality.reason = estimate.converged
                         ? "the readings leave a parameter of the shape free"
                         : "no shape of this kind is nearest to the readings: the fit does not settle";
    return false;
  }
  const int dof = quality.degrees_of_freedom;
  quality.rms = local.scale * std::sqrt(estimate.plain / static_cast<double>(local.count()));
  quality.residual_sd = dof > 0 ? local.scale * std::sqrt(estimate.plain / dof) : 0.0;
  quality.chi2_per_dof = !local.weighted() ? 1.0 : dof > 0 ? estimate.chi2 / dof : 0.0;
  return true;
}

/// Is there anything to tell the result's uncertainty by? Covariances, or a degree of freedom.
template <class Model, int Groups>
bool tellsUncertainty(const Estimate<Model, Groups>& estimate, const LocalPoints& local) {
  return local.weighted() || estimate.degreesOfFreedom() > 0;
}

/// A standard uncertainty of a direction (rad) from which on it is no direction any more.
inline constexpr double kNoDirection = 0.5;

/// A radius is determined where the curvature 1/r differs from that of a straight line by two standard
/// uncertainties.
inline bool curved(double radius, double sd) { return radius > 2.0 * sd; }

}  // namespace stiffscope
