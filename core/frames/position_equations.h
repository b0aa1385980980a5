#pragma once

#include <optional>
#include <vector>

#include "core/campaign/state_points.h"
#include "core/frames/arm_geometry.h"
#include "core/frames/frames.h"

namespace stiffscope::frames {

/// One-sigma share to which the sag by the identified stiffnesses and the URDF's masses is trusted. A choice,
/// not derived: a tenth is what CAD masses without cables, grease and dressing are off by, and what bearings
/// that give put into a joint's stiffness. Simulated days with every mass drawn a tenth off (80) keep
/// frame_moved, unloaded_positions and joint_read_back below half of their limits.
inline constexpr double kSagShare = 0.1;

/// One unloaded reflector against the model, in R0: measured less modelled, and how the model moves with the
/// parameters: ArmParameters about the centre, axes as swept, then the compliances in parts of themselves, one a joint.
struct AbsoluteRow {
  int pose = 0;
  int target = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< measured
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Eigen::Matrix3d weight = Eigen::Matrix3d::Zero();  ///< inverse covariance of the reading
  Eigen::MatrixXd jacobian;                          ///< 3 x parameters
  JointVector sag;                                   ///< of the posture's joints by the own weight, rad
  PointJacobian by_angles;                           ///< by the posture's joint angles
};

struct AbsoluteRows {
  Remark reason;  ///< why there are none
  std::vector<AbsoluteRow> rows;
  std::vector<int> poses;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< mean of the measured points
  int targets = 0;
  int axes = 0, joints = 0;
  int parameters = 0;
  Eigen::MatrixXd prior;  ///< inverse covariance of what is known beforehand: axes by their sweeps, compliances
};

AbsoluteRows absoluteRows(const campaign::Campaign& campaign, const Frames& frames, const LoadingGeometry& geometry,
                          const std::vector<campaign::StatePoints>& states,
                          const std::optional<metrology::TrackerNoise>& noise);

}  // namespace stiffscope::frames
