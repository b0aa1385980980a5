#include "core/preparation/standing_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"

namespace stiffscope::preparation {

namespace {

/// Repeats of one reflector in one load state.
struct StandingState {
  int target = 0, step = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), first = Eigen::Vector3d::Zero(), last = Eigen::Vector3d::Zero();
  int readings = 0;

  void add(const Eigen::Vector3d& point) {
    if (readings++ == 0) first = point;
    sum += point;
    last = point;
  }
  Eigen::Vector3d mean() const { return sum / readings; }
};

/// Those of each posture, a dozen in most days, in the order in which they were first read.
std::vector<std::vector<StandingState>> statesByPose(const campaign::Campaign& campaign) {
  std::vector<std::vector<StandingState>> by_pose(campaign.pose_ids.size());
  for (const campaign::LoadingReading& row : campaign.loading->rows) {
    std::vector<StandingState>& states = by_pose[static_cast<std::size_t>(row.pose)];
    auto state = std::find_if(states.rbegin(), states.rend(), [&](const StandingState& one) {
      return one.target == row.target && one.step == row.step;
    });
    if (state == states.rend()) {
      states.emplace_back(StandingState{.target = row.target, .step = row.step});
      state = states.rbegin();
    }
    state->add(row.point);
  }
  return by_pose;
}

}  // namespace

StandingMotion standingMotion(const campaign::Campaign& campaign) {
  StandingMotion motion;
  if (!campaign.loading) return motion;
  std::vector<std::pair<double, double>> moved;  // |u|, m
  double product = 0.0, squares = 0.0;
  for (std::vector<StandingState>& states : statesByPose(campaign)) {
    std::sort(states.begin(), states.end(), [](const StandingState& a, const StandingState& b) {
      return std::pair(a.target, a.step) < std::pair(b.target, b.step);
    });
    for (std::size_t k = 1; k < states.size(); ++k) {
      const StandingState &before = states[k - 1], &now = states[k];
      if (before.target != now.target || now.readings < 2) continue;
      const Eigen::Vector3d change = now.mean() - before.mean();
      const double size = change.norm();
      if (!(size > 0.0)) continue;
      moved.emplace_back(size, (now.last - now.first).dot(change) / size);
      product += size * moved.back().second;
      squares += size * size;
    }
  }
  constexpr int kFew = 10;
  motion.states = static_cast<int>(moved.size());
  if (motion.states < kFew) return motion;
  motion.share = product / squares;
  motion.rms = std::abs(motion.share) * std::sqrt(squares / motion.states);
  double left = 0.0;
  for (const auto& [size, along] : moved) left += (along - motion.share * size) * (along - motion.share * size);
  const double dof = motion.states - 1;
  motion.limit = numerics::studentLimit(kLevel, dof);
  if (left > 0.0) motion.t = motion.share * std::sqrt(squares * dof / left);
  return motion;
}

}  // namespace stiffscope::preparation
