#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/calibration/effect_terms.h"
#include "core/calibration/unloaded_day.h"
#include "core/frames/arm_parameters.h"

namespace stiffscope::calibration {

/// Where the readings' frame and the reflectors stand by the nominal arm alone: a start, good to what the nominal arm
/// is.
struct ArmPlace {
  Eigen::Isometry3d base_from_points = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3d> targets_at_zero;  ///< in base_link with all joints at zero, one a target
};

/// Finds them from the postures, from one reflector on: the readings are registered on the modelled points, the
/// reflectors are the mean of where the readings put them on the flange, in turns. Each turn leaves out the fifth of
/// the readings that fits worst, so that a few readings which are wrong by any amount do not matter. `weights`: one a
/// reading in the order of the day, 0: not used. Several starts for reflectors far from the flange; the one with the
/// smallest median distance is taken. Empty with fewer than four readings, or readings on one line.
std::optional<ArmPlace> placeArm(const UnloadedDay& day, const std::vector<double>& weights);

/// An arm fitted to a day, all in base_link: axes, base, reflectors as frames::ArmParameters, and sizes of effects.
///   y = B exp(xi_1 q'_1) ... exp(xi_n q'_n) x_t + sum_k offset_k a_k,   q' = q + sum_k angles_k a_k
/// Of a day of several stations the later ones' poses are found with it, known beforehand to what the nests tell.
/// The readings' frame stands against base_link by `base_from_points` and the base's parameters. What frames leave free
/// is held in the axes: 1 and 2 keep what the postures do not see of them.
struct ArmFit {
  bool done = false;
  ArmPlace place;
  frames::AxesAtStart start;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::VectorXd steps;  ///< frames::ArmParameters
  std::vector<EffectPart> parts;
  /// What the stations' poses may be off by, in parts of their standard uncertainties: no effect, and in no list.
  std::vector<EffectTerm> stations;
  Eigen::VectorXd sizes;        ///< of the terms of `parts`, in their order, then of `stations`
  std::vector<bool> refused;    ///< of each of these: a compliance that would be negative, left at zero
  std::vector<double> weights;  ///< one a reading: 1 used, 0 not used or rejected
  std::vector<int> free;        ///< places in (steps, sizes)
  std::vector<int> held;        ///< axis parameters that are a choice of frame, or that the postures do not see
  Eigen::MatrixXd covariance;   ///< of `free`
  double model_sd = 0.0;        ///< per coordinate, of what the model leaves beyond the tracker's declared noise, m
  double chi2_per_dof = 0.0;
  double design_effect = 1.0;  ///< by how much reflectors of one posture err together: variance of their sum
  int parameters = 0;          ///< free ones, but those of the stations

  /// In `steps`.
  frames::ArmParameters places() const { return frames::ArmParameters(static_cast<int>(start.size())); }

  robot::Robot arm(const robot::Robot& nominal) const;  ///< the calibrated one
  Eigen::Isometry3d basePointsMotion() const;           ///< base_from_points, the base's parameters in it
  std::vector<Eigen::Vector3d> targetsAtZero() const;
  Eigen::Index stationsAt() const;  ///< where the sizes of `stations` begin, in (steps, sizes)
  double sd(int parameter) const;   ///< of a place in (steps, sizes); 0 where it is held
};

}  // namespace stiffscope::calibration
