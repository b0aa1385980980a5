#include "core/diagnosis/start_state.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/statics/joint_torque.h"

namespace stiffscope {

Eigen::Vector3d loadOffset(const Robot& arm, const std::vector<LoadCase>& cases, double moment_sigma) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const LoadCase& one : cases) {
    const Eigen::Matrix3d flange_from_base =
        one.flange_unloaded.value_or(flangeAt(arm, unloadedPosture(arm, one))).linear().transpose();
    const Eigen::Vector3d force = flange_from_base * one.wrench.force;
    const Eigen::Vector3d moment = flange_from_base * one.wrench.moment;
    Eigen::Matrix3d by_offset;
    for (int k = 0; k < 3; ++k) by_offset.col(k) = Eigen::Vector3d::Unit(k).cross(force);
    normal += by_offset.transpose() * by_offset;
    right += by_offset.transpose() * moment;
  }
  constexpr double kExpected = 0.3;    // m
  constexpr double kRounding = 1e-12;  // of the readings, where their noise is not stated
  const double doubt = moment_sigma * moment_sigma / (kExpected * kExpected) + kRounding * normal.trace();
  if (doubt <= 0.0) return Eigen::Vector3d::Zero();
  normal.diagonal().array() += doubt;
  return normal.ldlt().solve(right);
}

namespace {

Vector6d largestTorque(const LoadingGeometry& geometry, const std::vector<LoadCase>& cases) {
  Vector6d largest = Vector6d::Zero();
  for (const LoadCase& one : cases) {
    const Vector6d weight = geometry.weight.links_known
                                ? weightTorque(geometry.arm, unloadedPosture(geometry.arm, one), geometry.weight)
                                : Vector6d(Vector6d::Zero());
    const Vector6d load = jointTorque(one.axes, one.wrench);
    largest = largest.cwiseMax(weight.cwiseAbs()).cwiseMax((weight + load).cwiseAbs());
  }
  return largest;
}

}  // namespace

GapState startState(const Campaign& campaign, const LoadingGeometry& geometry,
                    const std::vector<LoadCase>& cases) {
  GapState state;
  state.geometry = geometry;
  state.at.compliance = geometry.compliance.cwiseMax(0.0);
  state.at.targets = static_cast<int>(campaign.targets.size());
  state.at.r0_from_base_link = geometry.r0_from_base_link;
  state.at.load_offset = loadOffset(geometry.arm, cases, campaign.load_cell->moment_sigma);
  state.at.largest_torque = largestTorque(geometry, cases);
  if (geometry.r0_from_loading) state.r0_from_sweeps = *geometry.r0_from_loading;
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const State& row : campaign.states->rows) {
    state.at.largest_force = std::max(state.at.largest_force, row.wrench_in_cell.head<3>().norm());
    if (std::isfinite(row.time_s)) first = std::min(first, row.time_s), last = std::max(last, row.time_s);
  }
  if (last > first) state.at.first_time = first, state.at.time_span = last - first;
  state.at.sweep_time = std::isfinite(first) ? first : 0.0;
  if (geometry.r0_from_loading && campaign.loading && !campaign.loading->rows.empty()) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const LoadingReading& row : campaign.loading->rows) sum += row.point;
    state.at.epoch_centre =
        *geometry.r0_from_loading * (sum / static_cast<double>(campaign.loading->rows.size()));
  }
  return state;
}

}  // namespace stiffscope
