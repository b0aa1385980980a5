#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/calibration/arm_place.h"
#include "core/calibration/effect_terms.h"
#include "core/calibration/unloaded_day.h"
#include "core/frames/arm_parameters.h"

namespace stiffscope::calibration {

/// Before any reading an axis is known to lie within this of where the URDF has it, one sigma: m and rad. Beyond it the
/// machine is another. It decides nothing that the postures see, and keeps what they hardly see from wandering.
inline constexpr double kAxisShiftPrior = 0.01, kAxisTiltPrior = 0.01;

/// A reading further than this from the fullest model, in parts of the standard deviation of what is left, is wrong:
/// under a normal distribution one of 10^10 is.
inline constexpr double kGross = 7.0;

/// The same while effects are not in the model yet: the postures that show them best are the worst of geometry alone.
inline constexpr double kGrossOfGeometry = 15.0;

struct FitOptions {
  bool axes = true;             ///< false: base and reflectors alone are fitted to the nominal arm
  bool robust = true;           ///< false: `weights` say which readings are right
  std::vector<double> weights;  ///< one a reading in the order of the day; 0: not used
  double gross = kGross;
};

/// An arm fitted to a day, all in base_link: axes, base, reflectors as frames::ArmParameters, and sizes of effects.
///   y = B exp(xi_1 q'_1) ... exp(xi_6 q'_6) x_t + sum_k offset_k a_k,   q' = q + sum_k angles_k a_k
/// The readings' frame stands against base_link by `base_from_points` and the base's parameters. What frames leave free
/// is held in the axes: 1 and 2 keep what the postures do not see of them.
struct ArmFit {
  bool done = false;
  ArmPlace place;
  frames::AxesAtStart start;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::VectorXd steps;  ///< frames::ArmParameters
  std::vector<EffectPart> parts;
  Eigen::VectorXd sizes;        ///< of the terms of `parts`, in their order
  std::vector<bool> refused;    ///< of each term: a compliance that would be negative, left at zero
  std::vector<double> weights;  ///< one a reading: 1 used, 0 not used or rejected
  std::vector<int> free;        ///< places in (steps, sizes)
  std::vector<int> held;        ///< axis parameters that are a choice of frame, or that the postures do not see
  Eigen::MatrixXd covariance;   ///< of `free`
  double model_sd = 0.0;        ///< per coordinate, of what the model leaves beyond the tracker's declared noise, m
  double chi2_per_dof = 0.0;
  double design_effect = 1.0;  ///< by how much reflectors of one posture err together: variance of their sum
  int parameters = 0;

  robot::Robot arm(const robot::Robot& nominal) const;  ///< the calibrated one
  Eigen::Isometry3d basePointsMotion() const;           ///< base_from_points, the base's parameters in it
  std::vector<Eigen::Vector3d> targetsAtZero() const;
  double sd(int parameter) const;  ///< of a place in (steps, sizes); 0 where it is held
};

/// Weighted least squares by Gauss-Newton, normal equations summed posture by posture. A reading's covariance is the
/// tracker's and, where the model leaves more than that, a share that is alike for all (variance component found with
/// the fit). `robust`: Tukey's biweight until it settles, then what is beyond kGross is rejected and the rest counts
/// fully. Compliances that come out negative are refused one after the other.
/// Starts from the axes, base and reflectors of `from` where there is one, a fit of the same day from the same place.
ArmFit fitArm(const UnloadedDay& day, const ArmPlace& place, const std::vector<EffectPart>& parts,
              const FitOptions& options, const ArmFit* from = nullptr);

}  // namespace stiffscope::calibration
