#include "core/identification/load_readings.h"

#include <algorithm>
#include <utility>

#include "core/parallel/on_all_cores.h"

namespace stiffscope {

LoadReadings::LoadReadings(const Campaign& campaign, std::vector<int> steps)
    : steps_(std::move(steps)),
      poses_(campaign.pose_ids.size()),
      targets_(campaign.targets.size()),
      states_((steps_.size() + 1) * poses_, nullptr) {
  const auto asked = [&](int step) { return slot(step) <= steps_.size(); };
  const auto add = [&](const auto& row, const Eigen::Vector3d& value, std::vector<ReadingSum>& table) {
    if (!asked(row.step)) return;
    ReadingSum& sum = table[at(static_cast<std::size_t>(row.pose), row.step) * targets_ +
                            static_cast<std::size_t>(row.target)];
    sum.sum += value;
    ++sum.readings;
  };
  const auto gatherStates = [&] {
    if (!campaign.states) return;
    for (const State& state : campaign.states->rows) {
      if (asked(state.step)) states_[at(static_cast<std::size_t>(state.pose), state.step)] = &state;
    }
  };
  const auto gatherReadings = [&] {
    if (campaign.loading) {
      points_.resize(states_.size() * targets_);
      for (const LoadingReading& row : campaign.loading->rows) add(row, row.point, points_);
    }
    if (campaign.displacements) {
      differences_.resize(states_.size() * targets_);
      for (const Displacement& row : campaign.displacements->rows) add(row, row.displacement, differences_);
    }
  };
  onAllCores(2, [&](std::size_t i) { i == 0 ? gatherStates() : gatherReadings(); }, poses_ >= kWorthThreads);
}

std::size_t LoadReadings::slot(int step) const {
  if (step == 0) return 0;
  return 1 + static_cast<std::size_t>(std::find(steps_.begin(), steps_.end(), step) - steps_.begin());
}

std::span<const ReadingSum> LoadReadings::of(const std::vector<ReadingSum>& table, std::size_t pose,
                                             int step) const {
  if (table.empty()) return {};
  return {table.data() + at(pose, step) * targets_, targets_};
}

}  // namespace stiffscope
