#pragma once

#include <optional>
#include <vector>

#include "core/frames/frames.h"

namespace stiffscope::frames {

/// What a method takes as the geometry of the loaded arm, all in its base frame (R0): the arm, where the
/// reflectors stand on it, how the loading's readings come into it, and the stiffnesses by which its own
/// weight bends it.
struct LoadingGeometry {
  robot::Robot arm;
  std::vector<std::optional<Eigen::Vector3d>> targets_at_zero;
  std::optional<Eigen::Isometry3d> r0_from_loading;    ///< empty: absolute points of the loading cannot be used
  std::optional<Eigen::Matrix3d> displacements_in_r0;  ///< turns the `displacements` table's vectors into R0
  Eigen::Isometry3d r0_from_base_link = Eigen::Isometry3d::Identity();
  robot::GravityLoad weight;
  JointVector compliance;  ///< for the gravity sag, rad/Nm; zero or empty: rigid

  /// Turns of the joint springs under torques, rad.
  JointVector springTurns(const JointVector& torque) const {
    return compliance.size() > 0 ? JointVector(compliance.cwiseProduct(torque)) : JointVector::Zero(torque.size());
  }

  /// Joint angles with the sag in.
  JointVector sagged(const JointVector& q) const { return robot::saggedAngles(arm, q, weight, compliance); }
};

/// The geometry as the sweeps give it, for Complete Pose and Decoupled Partial Pose.
LoadingGeometry sweptGeometry(const campaign::Campaign& campaign, const Frames& frames, const JointVector& compliance);

}  // namespace stiffscope::frames
