#pragma once

#include <vector>

#include "core/calibration/fitted_arm.h"

namespace stiffscope::calibration {

/// Before any reading an axis is known to lie within this of where the URDF has it, one sigma: m and rad. Beyond it the
/// machine is another. It decides nothing that the postures see, and keeps what they hardly see from wandering.
inline constexpr double kAxisShiftPrior = 0.01, kAxisTiltPrior = 0.01;

/// A reading further than this from the fullest model, in parts of the standard deviation of what is left, is wrong:
/// under a normal distribution one of 10^10 is.
inline constexpr double kGross = 7.0;

struct FitOptions {
  bool axes = true;             ///< false: base and reflectors alone are fitted to the nominal arm
  bool robust = true;           ///< false: `weights` say which readings are right
  std::vector<double> weights;  ///< one a reading in the order of the day; 0: not used
  double gross = kGross;
};

/// Weighted least squares by Gauss-Newton, normal equations summed posture by posture. A reading's covariance is the
/// tracker's and, where the model leaves more than that, a share that is alike for all (variance component found with
/// the fit). `robust`: Tukey's biweight until it settles, then what is beyond kGross is rejected and the rest counts
/// fully. Compliances that come out negative are refused one after the other.
/// Starts from the axes, base and reflectors of `from` where there is one, a fit of the same day from the same place.
ArmFit fitArm(const UnloadedDay& day, const ArmPlace& place, const std::vector<EffectPart>& parts,
              const FitOptions& options, const ArmFit* from = nullptr);

}  // namespace stiffscope::calibration
