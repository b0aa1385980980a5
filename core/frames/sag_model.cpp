#include "core/frames/sag_model.h"

#include <utility>

namespace stiffscope {

SagModel::SagModel(Robot arm_in_r0, OwnWeight weight, const Vector6d& compliance,
                   std::vector<std::optional<Eigen::Vector3d>> targets_in_r0_at_zero,
                   const Eigen::Isometry3d& points_from_r0)
    : active_(weight.any() && !compliance.isZero()),
      arm_(std::move(arm_in_r0)),
      weight_(std::move(weight)),
      compliance_(compliance),
      targets_(std::move(targets_in_r0_at_zero)),
      points_from_r0_(points_from_r0.linear()) {}

Eigen::Vector3d SagModel::displacement(const Vector6d& q, int target) const {
  if (!active_) return Eigen::Vector3d::Zero();
  const auto& at_zero = targets_[static_cast<std::size_t>(target)];
  if (!at_zero) return Eigen::Vector3d::Zero();
  const ArmPosture rigid = postureAt(arm_, q);
  const ArmPosture sagged = postureAt(arm_, saggedAngles(arm_, q, weight_, compliance_));
  return points_from_r0_ * (sagged.motion[6] * *at_zero - rigid.motion[6] * *at_zero);
}

}  // namespace stiffscope
