#pragma once

#include <Eigen/Core>

#include "core/campaign/campaign.h"
#include "core/robot/robot.h"

namespace stiffscope::mistakes {

/// What the load cell shows in step 0 of every posture, which is nothing where it is tared and its zero stays.
struct CellZero {
  double chi2 = 0.0;                 ///< of the readings about what is found below, by the declared noise
  int dof = 0;                       ///< 0: too few readings, no declared noise, or figures that never change: not read
  bool drifts = false;               ///< they follow a line in time, which explains more than all else that is in them
  bool weighs = false;               ///< they follow a weight that turns with the postures, likewise
  double before = 0.0, after = 0.0;  ///< scatter in parts of the declared noise: about the mean, both taken off
  double drift_force = 0.0, drift_moment = 0.0;  ///< from the first reading to the last, N and Nm
  double hours = 0.0;                            ///< between these
  double mass = 0.0;                             ///< of the weight, kg
  double force = 0.0, force_left = 0.0;          ///< rms of the forces as read, and of what is then left of them, N
};

/// Weighted least squares of the six components in a constant, a line in time, and a weight m with its place:
/// F = m g, M = m c x g in the cell's axes. Line and weight are looked for where the readings scatter by more than
/// twice what is declared, which chance does not make; each is found where it explains more of them than chance, and
/// more than is left with both.
CellZero cellZero(const campaign::Campaign& campaign);

/// Gravity in the axes in which the cell's readings are written, m/s^2.
Eigen::Vector3d gravityInCell(const campaign::Campaign& campaign, const robot::Robot& robot,
                              const Eigen::Vector3d& gravity_in_base, const JointVector& q);

}  // namespace stiffscope::mistakes
