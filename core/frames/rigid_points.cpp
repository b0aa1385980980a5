#include "core/frames/rigid_points.h"

#include <algorithm>

namespace stiffscope {

namespace {

template <class Row>
std::vector<Eigen::Vector3d> lessSag(const std::vector<Row>& rows, const SagModel& sag, double& largest) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(rows.size());
  for (const Row& row : rows) {
    const Eigen::Vector3d shift = sag.displacement(row.q, row.target);
    largest = std::max(largest, shift.norm());
    points.push_back(row.point - shift);
  }
  return points;
}

}  // namespace

RigidPoints rigidPoints(const Campaign& campaign, const SagModel& sag) {
  RigidPoints points;
  if (campaign.circle_sweeps) points.circle_sweeps = lessSag(campaign.circle_sweeps->rows, sag, points.largest_sag);
  if (campaign.wrist_sweep) points.wrist_sweep = lessSag(campaign.wrist_sweep->rows, sag, points.largest_sag);
  return points;
}

}  // namespace stiffscope
