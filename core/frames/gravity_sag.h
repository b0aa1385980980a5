#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/robot/gravity_load.h"

namespace stiffscope::frames {

/// How far a reflector sags under the arm's own weight at a posture, so that readings can be referred to the rigid
/// arm. All in R0, but for the result, which is turned into the frame of the readings.
class SagModel {
 public:
  /// No sag: masses or stiffnesses not known.
  SagModel() = default;
  SagModel(robot::Robot arm_in_r0, robot::GravityLoad weight, const JointVector& compliance,
           std::vector<std::optional<Eigen::Vector3d>> targets_in_r0_at_zero, const Eigen::Isometry3d& points_from_r0);

  bool active() const { return active_; }

  /// Motion of the last body from zero at one posture, by the joint angles and with the sag.
  struct Stop {
    Eigen::Isometry3d rigid, sagged;
  };

  /// Where the sag is active: the last body at joint angles q, which all targets of a stop have in common.
  Stop at(const JointVector& q) const;

  /// Displacement of target `target` there, in the axes of the readings, m; zero where its place is not known.
  Eigen::Vector3d displacement(const Stop& at, int target) const;

 private:
  bool active_ = false;
  robot::Robot arm_;
  robot::GravityLoad weight_;
  JointVector compliance_;
  std::vector<std::optional<Eigen::Vector3d>> targets_;
  Eigen::Matrix3d points_from_r0_ = Eigen::Matrix3d::Identity();
};

/// The sweeps' readings referred to the rigid arm: each less the sag of its reflector at its joint angles. Rows as in
/// the campaign's tables, in the frame of the readings, m.
struct RigidPoints {
  std::vector<Eigen::Vector3d> circle_sweeps;
  std::vector<Eigen::Vector3d> wrist_sweep;
  double largest_sag = 0.0;  ///< largest correction of a reading, m
};

RigidPoints rigidPoints(const campaign::Campaign& campaign, const SagModel& sag);

}  // namespace stiffscope::frames
