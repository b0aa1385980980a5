#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/robot/robot.h"

namespace stiffscope::frames {

/// One reflector in the unloaded state of one posture: the mean of its readings, in the frame of the loading
/// table.
struct UnloadedPosition {
  int pose = 0;
  int target = 0;
  JointVector q;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  int readings = 0;
  int station = 0;                                     ///< from which it was read, index into Campaign::stations
  Eigen::Vector3d from = campaign::kStationOfTracker;  ///< where the instrument stood there
};

/// Where the base stands in the readings, and the reflectors on the flange, found from postures
/// alone where no sweep places R0: a start for the calibration.
struct BaseFromPostures {
  Eigen::Isometry3d points_from_base = Eigen::Isometry3d::Identity();
  std::vector<std::optional<Eigen::Vector3d>> targets_at_zero;
};

/// The rotations of the reflector triangle from the first posture to each other one are those of the flange
/// seen from another frame: their rotation vectors, brought onto each other, give the base's direction; the
/// rest is linear. Empty with fewer than three reflectors common to three postures, or with rotations about
/// one axis only. `q` of the positions as the arm stands, its sag in.
std::optional<BaseFromPostures> baseFromPostures(const robot::Robot& arm,
                                                 const std::vector<UnloadedPosition>& positions,
                                                 std::size_t target_count);

}  // namespace stiffscope::frames
