#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/calibration/arm_place.h"
#include "core/calibration/effect_terms.h"
#include "core/calibration/unloaded_day.h"
#include "core/frames/arm_parameters.h"

namespace stiffscope::calibration {

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

}  // namespace stiffscope::calibration
