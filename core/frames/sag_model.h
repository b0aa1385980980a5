#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/statics/own_weight.h"

namespace stiffscope {

/// How far a reflector sags under the arm's own weight at a posture, so that readings can be referred to the rigid
/// arm. All in R0, but for the result, which is turned into the frame of the readings.
class SagModel {
 public:
  /// No sag: masses or stiffnesses not known.
  SagModel() = default;
  SagModel(Robot arm_in_r0, OwnWeight weight, const Vector6d& compliance,
           std::vector<std::optional<Eigen::Vector3d>> targets_in_r0_at_zero, const Eigen::Isometry3d& points_from_r0);

  bool active() const { return active_; }

  /// Displacement of target `target` by the sag at joint angles q, in the axes of the readings, m.
  Eigen::Vector3d displacement(const Vector6d& q, int target) const;

 private:
  bool active_ = false;
  Robot arm_;
  OwnWeight weight_;
  Vector6d compliance_ = Vector6d::Zero();
  std::vector<std::optional<Eigen::Vector3d>> targets_;
  Eigen::Matrix3d points_from_r0_ = Eigen::Matrix3d::Identity();
};

}  // namespace stiffscope
