#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/identification/identify.h"

namespace stiffscope::planning {

/// What the user says of the day to come. Places in base_link or flange axes, m.
struct PlanningInputs {
  std::optional<double> load;  ///< N; empty: the mean force of the campaign's heaviest step
  std::optional<bool>
      pull;  ///< a cable pulls in any of several directions, or (false) the load hangs; empty: as measured
  std::optional<Eigen::Vector3d> hook_in_flange;   ///< where the load acts; empty: from the measured wrenches
  std::optional<Eigen::Vector3d> tracker_in_base;  ///< the station; empty: where the sweeps place it
  int repeats = 3;               ///< readings of a reflector in a state: their mean has less noise
  double tracker_sigma = 20e-6;  ///< m per coordinate, where the campaign declares no tracker
};

/// What a plan is made for: the arm in R0 with its reflectors, load and tracker, as far as they are known.
struct PlanningArm {
  frames::LoadingGeometry geometry;
  campaign::LoadCell cell;
  std::vector<Eigen::Vector3d> targets_in_flange;                ///< m
  Eigen::Vector3d outward_in_flange = Eigen::Vector3d::UnitZ();  ///< along axis 6, away from the arm
  Eigen::Vector3d hook_in_flange = Eigen::Vector3d::Zero();
  double load = 0.0;  ///< N
  bool pull = false;
  std::optional<Eigen::Vector3d> station;  ///< in R0, m
  std::optional<metrology::TrackerNoise> noise;       ///< about `station`; empty: isotropic `sigma`
  double sigma = 0.0;                      ///< m per coordinate of one reading, where `noise` is empty
  double misfit = 0.0;  ///< m per coordinate: what the identified model leaves, 0 if unknown
  int repeats = 1;
  std::vector<std::string> assumed;  ///< what was taken for granted, a sentence each

  /// Covariance of a reflector's displacement at `point` (R0), m^2: unloaded and loaded means, and the
  /// misfit.
  Eigen::Matrix3d displacementCovariance(const Eigen::Vector3d& point) const;
};

/// From a campaign before its day (robot, load cell, targets) or after it (`identified`, of the same
/// campaign): then sweeps, hook, load and misfit come from the measurement. Nominal reflector places (`x_mm
/// y_mm z_mm` of `target`) or, without them, three on a ring of 250 mm about the flange. Throws InputError
/// where the load is neither given nor measured, or no force.
PlanningArm planningArm(const campaign::Campaign& campaign, const identification::Identification* identified,
                        const PlanningInputs& inputs);

}  // namespace stiffscope::planning
