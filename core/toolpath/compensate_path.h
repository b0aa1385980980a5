#pragma once

#include <vector>

#include "core/compensation/compensate.h"
#include "core/toolpath/joint_path.h"
#include "core/toolpath/tool_path.h"

namespace stiffscope::toolpath {

/// What is to be done along a path.
struct PathJob {
  ToolPath path;
  Eigen::Isometry3d base_from_workpiece = Eigen::Isometry3d::Identity();  ///< in base_link
  Eigen::Isometry3d flange_from_tool = Eigen::Isometry3d::Identity();
  ProcessLoad load;
  bool turn_free = false;  ///< the tool may turn about its axis
  JointPathOptions joints;
};

/// The elastic arm that predicts: as `compensate` takes it.
struct PathArm {
  const campaign::Campaign& campaign;
  const frames::LoadingGeometry& geometry;
  const identification::StiffnessEstimate& estimate;
  const effects::EffectDeflection* with = nullptr;
  const compensation::Certainty* certainty = nullptr;
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
  SmallMotion deflection;                    ///< by the process, without compensation
  SmallMotion offset;                        ///< to add to the programmed pose, in place of other joint commands
  Vector6d joint_torque = Vector6d::Zero();  ///< of the process, Nm

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
/// Joint angles are those of the campaign's own geometry (`arm.geometry`, in R0), on one branch (jointPath), then moved
/// until the arm that its own weight bends holds the tool at the pose, to 1e-9 m and rad. From there `compensate`
/// predicts the deflection of the tip by the process load, which keeps its direction, and finds the commands, or says
/// why not. The Cartesian offset is what the commands are beside those joint angles by the same rigid kinematics: p' =
/// p + shift, R' = Exp(turn) R, in the workpiece's axes.
CompensatedPath compensatePath(const PathArm& arm, const PathJob& job);

}  // namespace stiffscope::toolpath
