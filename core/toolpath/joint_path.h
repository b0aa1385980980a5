#pragma once

#include <optional>
#include <vector>

#include "core/robot/inverse_kinematics.h"
#include "core/robot/robot.h"
#include "metrology/remark.h"

namespace stiffscope::toolpath {

struct JointPathOptions {
  std::optional<Vector6d> start;     ///< near it lies the branch that is wanted, rad; empty: the best of all found
  std::vector<Vector6d> seeds;       ///< postures from which branches are looked for, besides drawn ones, rad
  double least_conditioning = 0.01;  ///< below it a posture is too near a singularity
  double turn_per_metre = 3.0;       ///< most of the free turn about the tool's axis, rad per m of the path
  /// Joint angles among which postures are preferred: those that a day identified from, rad. Of an infinite one there
  /// is no limit.
  std::optional<Vector6d> preferred_low, preferred_high;
};

/// Joint angles for one pose of the path.
struct JointPathPose {
  Vector6d q = Vector6d::Zero();                                     ///< rad
  Eigen::Isometry3d base_from_tool = Eigen::Isometry3d::Identity();  ///< with the turn about the tool's axis put in
  double turn = 0.0;          ///< about the tool's z axis, from the pose as it was given, rad
  double conditioning = 0.0;  ///< conditioningAt the tool's origin
  double limit_margin = 0.0;  ///< from the nearest joint limit, rad; negative outside
  int nearest_limit = 0;      ///< whose limit that is, 0..5
  Remark reason;              ///< why it is not usable; empty where it is
};

struct JointPath {
  std::vector<JointPathPose> poses;
  std::size_t branches = 0;  ///< that were followed from the first pose
};

/// Joint angles of the rigid arm along a path of its tool (base frame), on one branch: each pose is solved from the one
/// before (robot::inverseKinematics), in parts of at most 30 mm and 0.06 rad, and one that can only be had by a jump is
/// named. The first pose is solved from many postures, with the tool turned about its axis in steps of 30 deg where
/// `turn_free`; every branch found is followed to the end, and the one with the fewest unusable poses, then the lowest
/// mean cost, is taken. Cost of a posture, by which the free turn is moved too, at most `turn_per_metre`:
///   sum over joints (10 deg / margin to the limit)^2 + (0.05 / conditioning)^2 + sum (beyond the preferred angles / 15
///   deg)^2.
/// Whole turns of a joint are chosen for the whole path. A pose out of reach has the reason; the path goes on from the
/// last one that was reached.
JointPath jointPath(const robot::Robot& arm, const std::vector<Eigen::Isometry3d>& base_from_tool,
                    const Eigen::Isometry3d& flange_from_tool, bool turn_free, const JointPathOptions& options);

}  // namespace stiffscope::toolpath
