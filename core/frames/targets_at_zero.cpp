#include "core/frames/targets_at_zero.h"

#include "core/robot/kinematics.h"

namespace stiffscope {

std::vector<std::optional<Eigen::Vector3d>> targetsAtZero(const Campaign& campaign, const ArmInR0& arm,
                                                          const RigidPoints& points) {
  std::vector<std::optional<Eigen::Vector3d>> targets(campaign.targets.size());
  for (std::size_t k = 0; k < targets.size(); ++k) {
    if (const auto& declared = campaign.targets[k].position_in_flange) {
      targets[k] = arm.arm.base_from_flange_at_zero * *declared;
    }
  }
  if (!arm.points_placed) return targets;

  std::vector<Eigen::Vector3d> sums(targets.size(), Eigen::Vector3d::Zero());
  std::vector<int> counts(targets.size(), 0);
  const auto add = [&](const auto& rows, const std::vector<Eigen::Vector3d>& rigid) {
    Eigen::Isometry3d zero_from_now = Eigen::Isometry3d::Identity();
    for (std::size_t row = 0; row < rows.size(); ++row) {
      // The reflectors of one stop follow each other.
      if (row == 0 || rows[row].q != rows[row - 1].q) zero_from_now = postureAt(arm.arm, rows[row].q).motion[6].inverse();
      const auto k = static_cast<std::size_t>(rows[row].target);
      sums[k] += zero_from_now * (arm.r0_from_points * rigid[row]);
      ++counts[k];
    }
  };
  if (campaign.circle_sweeps) add(campaign.circle_sweeps->rows, points.circle_sweeps);
  if (campaign.wrist_sweep && campaign.wrist_sweep->frame == campaign.circle_sweeps->frame) {
    add(campaign.wrist_sweep->rows, points.wrist_sweep);
  }
  for (std::size_t k = 0; k < targets.size(); ++k) {
    if (counts[k] > 0) targets[k] = sums[k] / counts[k];
  }
  return targets;
}

}  // namespace stiffscope
