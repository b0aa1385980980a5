#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/arm_geometry.h"
#include "core/robot/robot.h"
#include "metrology/remark.h"

namespace stiffscope::frames {

/// One reflector in the unloaded state of one posture: the mean of its readings, in the frame of the loading
/// table.
struct UnloadedPosition {
  int pose = 0;
  int target = 0;
  JointVector q;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  int readings = 0;
};

/// Positions in load step 0, in the order of poses, then targets. Empty without `loading` or `states`.
std::vector<UnloadedPosition> unloadedPositions(const campaign::Campaign& campaign);

/// Where the base stands in the loading's readings, and the reflectors on the flange, found from postures
/// alone where no sweep places R0: a start for the calibration.
struct BaseFromPostures {
  Eigen::Isometry3d points_from_base = Eigen::Isometry3d::Identity();
  std::vector<std::optional<Eigen::Vector3d>> targets_at_zero;
};

/// The rotations of the reflector triangle from the first posture to each other one are those of the flange
/// seen from another frame: their rotation vectors, brought onto each other, give the base's direction; the
/// rest is linear. Empty with fewer than three reflectors common to three postures, or with rotations about
/// one axis only.
std::optional<BaseFromPostures> baseFromPostures(const LoadingGeometry& geometry,
                                                 const std::vector<UnloadedPosition>& positions,
                                                 std::size_t target_count);

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
/// parameters, or where the base's place can neither be taken from the sweeps nor from three or more reflectors.
GeometryCalibration calibrateGeometry(const campaign::Campaign& campaign, const LoadingGeometry& start);

}  // namespace stiffscope::frames
