#include "core/campaign/state_points.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/campaign/repeated_keys.h"
#include "core/campaign/row_names.h"

namespace stiffscope::campaign {

namespace {

using Source = StatePoints::Source;

/// Gathers readings by their state, in order of first appearance. Most follow one of the same state.
class Gatherer {
 public:
  explicit Gatherer(std::size_t targets) : targets_(targets) {}

  template <class Row>
  void add(Source source, int axis, const std::string& index, int pose, int step, const Row& row) {
    if (states_.empty() || !isOf(states_[last_], source, axis, index, pose, step)) {
      KeyHash key;
      key.add(static_cast<int>(source));
      key.add(axis);
      key.add(index);
      key.add(pose);
      key.add(step);
      last_ = seen_.add(states_.size(), key,
                        [&](std::size_t other) { return isOf(states_[other], source, axis, index, pose, step); });
      if (last_ == RepeatCheck::kNew) {
        last_ = states_.size();
        states_.emplace_back(StatePoints{source, axis, index, pose, step, {}}).reflectors.reserve(targets_);
      }
    }
    ReflectorMean& mean = of(states_[last_].reflectors, row);
    mean.point += row.point;
    ++mean.readings;
  }

  std::vector<StatePoints> finish() {
    for (StatePoints& state : states_) {
      for (ReflectorMean& mean : state.reflectors) mean.point /= mean.readings;
    }
    states_.shrink_to_fit();
    return std::move(states_);
  }

 private:
  static bool isOf(const StatePoints& state, Source source, int axis, const std::string& index, int pose, int step) {
    return state.source == source && state.axis == axis && state.index == index && state.pose == pose &&
           state.step == step;
  }

  template <class Row>
  static ReflectorMean& of(std::vector<ReflectorMean>& reflectors, const Row& row) {
    for (ReflectorMean& one : reflectors) {
      if (one.target == row.target) return one;
    }
    return reflectors.emplace_back(
        ReflectorMean{row.target, 0, Eigen::Vector3d::Zero(), row.line, row.station, row.from});
  }

  static constexpr std::size_t kFew = 1000;  // it grows

  std::size_t targets_;
  std::vector<StatePoints> states_;
  std::size_t last_ = 0;
  RepeatCheck seen_{kFew};
};

}  // namespace

const ReflectorMean* StatePoints::of(int target) const {
  for (const ReflectorMean& mean : reflectors) {
    if (mean.target == target) return &mean;
  }
  return nullptr;
}

const std::string& fileOf(const Campaign& campaign, const StatePoints& state) {
  if (state.source == Source::circle_sweeps) return campaign.circle_sweeps->file;
  return state.source == Source::wrist_sweep ? campaign.wrist_sweep->file : campaign.loading->file;
}

std::string nameOf(const Campaign& campaign, const StatePoints& state) {
  if (state.source == Source::circle_sweeps) return fmt::format("axis {}, index {}", state.axis + 1, state.index);
  if (state.source == Source::wrist_sweep) return fmt::format("wrist sweep, index {}", state.index);
  return fmt::format("pose {}, step {}", poseName(campaign, state.pose), state.step);
}

std::vector<StatePoints> statePoints(const Campaign& campaign) {
  Gatherer gatherer(campaign.targets.size());
  if (campaign.circle_sweeps) {
    for (const CircleReading& row : campaign.circle_sweeps->rows) {
      gatherer.add(Source::circle_sweeps, row.axis, row.index, -1, 0, row);
    }
  }
  if (campaign.wrist_sweep) {
    for (const WristReading& row : campaign.wrist_sweep->rows) {
      gatherer.add(Source::wrist_sweep, 0, row.index, -1, 0, row);
    }
  }
  if (campaign.loading) {
    for (const LoadingReading& row : campaign.loading->rows) {
      gatherer.add(Source::loading, 0, {}, row.pose, row.step, row);
    }
  }
  return gatherer.finish();
}

bool isUnloadedDay(const Campaign& campaign) {
  // A load cell that stayed in campaign.xml shows nothing: no cell reads zero in every row.
  if (!campaign.states || !campaign.loading) return false;
  const std::vector<State>& states = campaign.states->rows;
  return std::all_of(states.begin(), states.end(), [](const State& state) { return state.wrench_in_cell.isZero(); });
}

}  // namespace stiffscope::campaign
