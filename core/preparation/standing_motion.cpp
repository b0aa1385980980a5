#include "core/preparation/standing_motion.h"

#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"

namespace stiffscope::preparation {

namespace {

/// Repeats of one reflector in one load state.
struct StandingState {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), first = Eigen::Vector3d::Zero(), last = Eigen::Vector3d::Zero();
  int readings = 0;

  void add(const Eigen::Vector3d& point) {
    if (readings++ == 0) first = point;
    sum += point;
    last = point;
  }
  Eigen::Vector3d mean() const { return sum / readings; }
};

}  // namespace

StandingMotion standingMotion(const campaign::Campaign& campaign) {
  StandingMotion motion;
  if (!campaign.loading) return motion;
  std::map<std::tuple<int, int, int>, StandingState> states;  // pose, reflector, step
  for (const campaign::LoadingReading& row : campaign.loading->rows)
    states[{row.pose, row.target, row.step}].add(row.point);
  std::vector<std::pair<double, double>> moved;  // |u|, m
  double product = 0.0, squares = 0.0;
  for (auto now = states.begin(), before = now; now != states.end(); before = now++) {
    const auto& [pose, target, step] = now->first;
    if (now == before || std::get<0>(before->first) != pose || std::get<1>(before->first) != target) continue;
    if (now->second.readings < 2) continue;
    const Eigen::Vector3d change = now->second.mean() - before->second.mean();
    const double size = change.norm();
    if (!(size > 0.0)) continue;
    moved.emplace_back(size, (now->second.last - now->second.first).dot(change) / size);
    product += size * moved.back().second;
    squares += size * size;
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
