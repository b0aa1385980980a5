#include "core/audit/state_points.h"

#include <fmt/format.h>

#include <map>

namespace stiffscope {

namespace {

/// Gathers readings by the name of their state, in order of first appearance.
class Gatherer {
 public:
  explicit Gatherer(const std::optional<TrackerNoise>& noise) : noise_(noise) {}

  template <class Row>
  void add(const std::string& file, std::string name, int pose, int step, const Row& row) {
    const auto [found, added] = place_.try_emplace(file + '\n' + name, states_.size());
    if (added) states_.push_back({file, std::move(name), pose, step, {}});
    std::vector<ReflectorMean>& reflectors = states_[found->second].reflectors;
    ReflectorMean* mean = nullptr;
    for (ReflectorMean& one : reflectors) {
      if (one.target == row.target) mean = &one;
    }
    if (mean == nullptr) {
      reflectors.push_back({row.target, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), 0, row.line});
      mean = &reflectors.back();
    }
    mean->point += row.point;
    ++mean->readings;
  }

  std::vector<StatePoints> finish() {
    for (StatePoints& state : states_) {
      for (ReflectorMean& mean : state.reflectors) {
        mean.point /= mean.readings;
        if (noise_) mean.covariance = noise_->covarianceAt(mean.point) / mean.readings;
      }
    }
    return std::move(states_);
  }

 private:
  std::optional<TrackerNoise> noise_;
  std::vector<StatePoints> states_;
  std::map<std::string, std::size_t> place_;
};

}  // namespace

const ReflectorMean* StatePoints::of(int target) const {
  for (const ReflectorMean& mean : reflectors) {
    if (mean.target == target) return &mean;
  }
  return nullptr;
}

std::vector<StatePoints> statePoints(const Campaign& campaign, const std::optional<TrackerNoise>& noise) {
  Gatherer gatherer(noise);
  if (campaign.circle_sweeps) {
    for (const CircleReading& row : campaign.circle_sweeps->rows) {
      gatherer.add(campaign.circle_sweeps->file, fmt::format("axis {}, index {}", row.axis + 1, row.index),
                   -1, 0, row);
    }
  }
  if (campaign.wrist_sweep) {
    for (const WristReading& row : campaign.wrist_sweep->rows) {
      gatherer.add(campaign.wrist_sweep->file, fmt::format("wrist sweep, index {}", row.index), -1, 0, row);
    }
  }
  if (campaign.loading) {
    for (const LoadingReading& row : campaign.loading->rows) {
      const std::string& pose = campaign.pose_ids[static_cast<std::size_t>(row.pose)];
      gatherer.add(campaign.loading->file, fmt::format("pose {}, step {}", pose, row.step), row.pose,
                   row.step, row);
    }
  }
  return gatherer.finish();
}

}  // namespace stiffscope
