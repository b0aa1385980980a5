#include "core/frames/gravity_sag.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/numerics/parallel.h"

namespace stiffscope::frames {

namespace {

/// Rows of one stop, one behind the other, have one posture in common.
template <class Row>
std::vector<Eigen::Vector3d> lessSag(const std::vector<Row>& rows, const SagModel& sag, double& largest) {
  std::vector<Eigen::Vector3d> points(rows.size(), Eigen::Vector3d::Zero());
  if (sag.active()) {
    std::vector<std::size_t> stops;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i == 0 || rows[i].q != rows[i - 1].q) stops.push_back(i);
    }
    stops.push_back(rows.size());
    numerics::smallWorkOnAllCores(stops.size() - 1, [&](std::size_t stop) {
      const SagModel::Stop at = sag.at(rows[stops[stop]].q);
      for (std::size_t i = stops[stop]; i < stops[stop + 1]; ++i) points[i] = sag.displacement(at, rows[i].target);
    });
  }
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

SagModel::Stop SagModel::at(const JointVector& q) const {
  return {robot::postureAt(arm_, q).motion.back(),
          robot::postureAt(arm_, robot::saggedAngles(arm_, q, weight_, compliance_)).motion.back()};
}

Eigen::Vector3d SagModel::displacement(const Stop& at, int target) const {
  const auto& at_zero = targets_[static_cast<std::size_t>(target)];
  if (!at_zero) return Eigen::Vector3d::Zero();
  return points_from_r0_ * (at.sagged * *at_zero - at.rigid * *at_zero);
}

}  // namespace stiffscope::frames
