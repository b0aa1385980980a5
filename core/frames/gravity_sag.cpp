#include "core/frames/gravity_sag.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/numerics/parallel.h"

namespace stiffscope::frames {

namespace {

template <class Row>
std::vector<Eigen::Vector3d> lessSag(const std::vector<Row>& rows, const SagModel& sag, double& largest) {
  std::vector<Eigen::Vector3d> points(rows.size());
  numerics::smallWorkOnAllCores(rows.size(),
                                [&](std::size_t i) { points[i] = sag.displacement(rows[i].q, rows[i].target); });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    largest = std::max(largest, points[i].norm());
    points[i] = rows[i].point - points[i];
  }
  return points;
}

}  // namespace

RigidPoints rigidPoints(const campaign::Campaign& campaign, const SagModel& sag) {
  RigidPoints points;
  if (campaign.circle_sweeps) points.circle_sweeps = lessSag(campaign.circle_sweeps->rows, sag, points.largest_sag);
  if (campaign.wrist_sweep) points.wrist_sweep = lessSag(campaign.wrist_sweep->rows, sag, points.largest_sag);
  return points;
}

SagModel::SagModel(robot::Robot arm_in_r0, robot::GravityLoad weight, const JointVector& compliance,
                   std::vector<std::optional<Eigen::Vector3d>> targets_in_r0_at_zero,
                   const Eigen::Isometry3d& points_from_r0)
    : active_(weight.any() && !compliance.isZero()),
      arm_(std::move(arm_in_r0)),
      weight_(std::move(weight)),
      compliance_(compliance),
      targets_(std::move(targets_in_r0_at_zero)),
      points_from_r0_(points_from_r0.linear()) {}

Eigen::Vector3d SagModel::displacement(const JointVector& q, int target) const {
  if (!active_) return Eigen::Vector3d::Zero();
  const auto& at_zero = targets_[static_cast<std::size_t>(target)];
  if (!at_zero) return Eigen::Vector3d::Zero();
  const robot::ArmPosture rigid = robot::postureAt(arm_, q);
  const robot::ArmPosture sagged = robot::postureAt(arm_, robot::saggedAngles(arm_, q, weight_, compliance_));
  return points_from_r0_ * (sagged.motion.back() * *at_zero - rigid.motion.back() * *at_zero);
}

}  // namespace stiffscope::frames
