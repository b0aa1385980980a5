#include "core/frames/rigid_points.h"

#include <algorithm>
#include <cstddef>

#include "core/parallel/on_all_cores.h"

namespace stiffscope {

namespace {

template <class Row>
std::vector<Eigen::Vector3d> lessSag(const std::vector<Row>& rows, const SagModel& sag, double& largest) {
  std::vector<Eigen::Vector3d> points(rows.size());
  smallWorkOnAllCores(rows.size(), [&](std::size_t i) { points[i] = sag.displacement(rows[i].q, rows[i].target); });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    largest = std::max(largest, points[i].norm());
    points[i] = rows[i].point - points[i];
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
