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
  /// Where the flange turns about one direction only, as of a palletiser whose rods keep it level: that direction, in
  /// base axes. How far along it the base stands and how far along it the reflectors stand on the flange is then told
  /// in sum only; the reflectors' mean is put at the flange's height. Joint springs do not feel it: no joint tilts such
  /// a flange, so that all of its points, however high, move alike.
  std::optional<Eigen::Vector3d> open;

  /// Moves base and reflectors against each other, m: along `open`, which must be there, all readings stay explained.
  void slide(double by);
};

/// The rotations of the reflector triangle from the first posture to each other one are those of the flange
/// seen from another frame: their rotation vectors, brought onto each other, give the base's direction; the
/// rest is linear. Of rotations about one direction they give that direction alone; the turn about it is then told by
/// where the flange goes across it. Empty with fewer than three reflectors common to three postures, without rotations,
/// or where the flange goes on a circle about that one direction, as by joint 1 alone. `q` of the positions as the arm
/// stands, its sag in.
std::optional<BaseFromPostures> baseFromPostures(const robot::Robot& arm,
                                                 const std::vector<UnloadedPosition>& positions,
                                                 std::size_t target_count);

/// What is open (BaseFromPostures::open) as it is stated: by the reflectors' places at zero joint angles, base axes, or
/// else by the base's place in the readings, where the table is in base_link. Neither: as it is.
void slideToStated(const std::vector<std::optional<Eigen::Vector3d>>& targets_at_zero,
                   const std::optional<Eigen::Isometry3d>& points_from_base, BaseFromPostures& found);

}  // namespace stiffscope::frames
