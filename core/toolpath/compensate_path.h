#pragma once

#include <optional>
#include <vector>

#include "core/compensation/compensate.h"
#include "core/robot/inverse_kinematics.h"
#include "core/robot/robot.h"
#include "core/toolpath/tool_path.h"
#include "metrology/remark.h"

namespace stiffscope::toolpath {

struct JointPathOptions {
  std::optional<JointVector> start;  ///< near it lies the branch that is wanted, rad; empty: the best of all found
  std::vector<JointVector> seeds;    ///< postures from which branches are looked for, besides drawn ones, rad
  double least_conditioning = 0.01;  ///< below it a posture is too near a singularity
  double turn_per_metre = 3.0;       ///< most of the free turn about the tool's axis, rad per m of the path
  /// Joint angles among which postures are preferred: those that a day identified from, rad. Of an infinite one there
  /// is no limit.
  std::optional<JointVector> preferred_low, preferred_high;
};

/// Joint angles for one pose of the path.
struct JointPathPose {
  JointVector q;                                                     ///< rad
  Eigen::Isometry3d base_from_tool = Eigen::Isometry3d::Identity();  ///< with the turn about the tool's axis put in
  double turn = 0.0;          ///< about the tool's z axis, from the pose as it was given, rad
  double conditioning = 0.0;  ///< conditioningAt the tool's origin
  double limit_margin = 0.0;  ///< from the nearest joint limit, rad; negative outside
  int nearest_limit = 0;      ///< whose limit that is, from 0
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
///
/// Of more than six joints a branch is a family of postures: steps from one pose to the next turn the joints as little
/// as they can, and the cost chooses among the families that the first pose was found in, not along the path. Fewer
/// than six joints hold some poses only: then no pose has joint angles, and the reason says so.
JointPath jointPath(const robot::Robot& arm, const std::vector<Eigen::Isometry3d>& base_from_tool,
                    const Eigen::Isometry3d& flange_from_tool, bool turn_free, const JointPathOptions& options);

/// What is to be done along a path.
struct PathJob {
  ToolPath path;
  Eigen::Isometry3d base_from_workpiece = Eigen::Isometry3d::Identity();  ///< in base_link
  Eigen::Isometry3d flange_from_tool = Eigen::Isometry3d::Identity();
  ProcessLoad load;
  bool turn_free = false;  ///< the tool may turn about its axis
  JointPathOptions joints;
};

/// Six numbers of a small motion, in the workpiece's axes.
struct SmallMotion {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< of the tool's tip, m
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();   ///< rotation vector about the tip, rad
};

struct CompensatedPathPose {
  Eigen::Vector3d tip_in_workpiece = Eigen::Vector3d::Zero();  ///< as asked for, m
  Eigen::Matrix3d workpiece_from_tool = Eigen::Matrix3d::Identity();
  double along = 0.0;    ///< length of the path up to here, m
  JointPathPose joints;  ///< of the rigid arm
  ToolWrench wrench;     ///< on the tool, workpiece axes
  /// At the joint angles at which the arm, bent by its own weight, holds the tool at the pose. Not a number where there
  /// are none; its `tcp` is the tool's tip.
  compensation::CompensatedPosture compensated;
  SmallMotion deflection;    ///< by the process, without compensation
  SmallMotion offset;        ///< to add to the programmed pose, in place of other joint commands
  JointVector joint_torque;  ///< of the process, Nm

  ToolWrench wrenchAtTip() const;  ///< its moment about the tip
};

struct CompensatedPath {
  std::vector<CompensatedPathPose> poses;
  std::size_t branches = 0;  ///< that were followed

  /// For compensation::summaryOf.
  std::vector<compensation::CompensatedPosture> postures() const;
};

/// Joint commands along a path that keep the loaded tool where it is asked for.
///
/// `arm.tcp_in_flange` does not count: the tool's tip is `job`'s.
///
/// Joint angles are those of the campaign's own geometry (`arm.geometry`, in R0), on one branch (jointPath), then moved
/// until the arm that its own weight bends holds the tool at the pose, to 1e-9 m and rad. From there `compensate`
/// predicts the deflection of the tip by the process load, which keeps its direction, and finds the commands, or says
/// why not. The Cartesian offset is what the commands are beside those joint angles by the same rigid kinematics: p' =
/// p + shift, R' = Exp(turn) R, in the workpiece's axes.
CompensatedPath compensatePath(const compensation::DeflectingArm& arm, const PathJob& job);

}  // namespace stiffscope::toolpath
