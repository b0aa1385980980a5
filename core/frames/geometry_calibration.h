#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/arm_geometry.h"
#include "core/frames/base_from_postures.h"
#include "core/robot/robot.h"
#include "metrology/remark.h"

namespace stiffscope::frames {

/// Positions in load step 0, in the order of poses, then targets. Empty without `loading` or `states`.
std::vector<UnloadedPosition> unloadedPositions(const campaign::Campaign& campaign);

/// Result of calibrating geometry, base and tool points on unloaded absolute positions.
struct GeometryCalibration {
  bool done = false;
  Remark reason;             ///< why not
  LoadingGeometry geometry;  ///< the calibrated one; its compliance is that of the start
  /// The geometry moved along each column of a root S of its covariance C = S S^T: by (J^T J)^-1 of the whitened
  /// residuals, times chi^2 over degrees of freedom where that is above one, or no tracker is declared.
  std::vector<LoadingGeometry> spread;
  double rms_before = 0.0;  ///< plain, per coordinate, m: the starting geometry
  double rms_after = 0.0;
  int positions = 0;          ///< unloaded reflector positions used
  int parameters = 0;         ///< that were estimated
  std::vector<Remark> fixed;  ///< parameters that the data cannot see, kept at their start
};

/// Partial Pose's first step (Wu, Klimchik et al.; paper IV.B): ArmParameters by least squares on where the
/// reflectors stand unloaded in all postures (step 0), with the gravity sag at `start.compliance` in the
/// model; weighted by the tracker's covariance where it is declared. Solved by Ceres (Levenberg-Marquardt). Parameters
/// that the positions do not see (the axes can be shifted against base and tool) are found from the rank of the
/// Jacobian, fixed and named. Not done, with the reason: without absolute unloaded points, with fewer positions than
/// parameters, or where the base's place can neither be taken from the sweeps, from a table in base_link, nor from
/// three or more reflectors. Of a flange that turns about one direction only, as a palletiser's, how high the base
/// stands and how high the reflectors on the flange is told in sum: held as stated or as BaseFromPostures has it, and
/// named.
GeometryCalibration calibrateGeometry(const campaign::Campaign& campaign, const LoadingGeometry& start);

}  // namespace stiffscope::frames
