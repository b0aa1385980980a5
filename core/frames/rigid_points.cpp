#include "core/frames/rigid_points.h"

namespace stiffscope {

namespace {

template <class Row>
std::vector<Eigen::Vector3d> lessSag(const std::vector<Row>& rows, const SagModel& sag) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(rows.size());
  for (const Row& row : rows) points.push_back(row.point - sag.displacement(row.q, row.target));
  return points;
}

}  // namespace

RigidPoints rigidPoints(const Campaign& campaign, const SagModel& sag) {
  RigidPoints points;
  if (campaign.circle_sweeps) points.circle_sweeps = lessSag(campaign.circle_sweeps->rows, sag);
  if (campaign.wrist_sweep) points.wrist_sweep = lessSag(campaign.wrist_sweep->rows, sag);
  return points;
}

}  // namespace stiffscope
