#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "core/audit/checks.h"
#include "core/audit/redundancies.h"
#include "core/audit/remarks.h"
#include "core/campaign/row_names.h"
#include "core/numerics/resampling.h"
#include "core/preparation/remarks.h"

namespace stiffscope::audit {

namespace {

/// The value that comes up most often; the larger of two that do.
int mostCommon(const std::map<int, int>& counts) {
  int best = 0, most = 0;
  for (const auto& [value, count] : counts) {
    if (count >= most) most = count, best = value;
  }
  return best;
}

class Inventory {
 public:
  explicit Inventory(const campaign::Campaign& campaign) : campaign_(campaign) {
    if (campaign.loading) {
      for (const campaign::LoadingReading& row : campaign.loading->rows) add(row.pose, row.step, row.target);
    } else {
      for (const campaign::Displacement& row : campaign.displacements->rows) add(row.pose, row.step, row.target);
    }
    for (const campaign::State& state : campaign.states->rows) states_.insert({state.pose, state.step});
    std::map<int, int> repeats;
    for (const auto& [pose, steps] : readings_) {
      for (const auto& [step, targets] : steps) {
        ++poses_with_[step];
        for (const auto& [target, count] : targets) ++repeats[count], targets_.insert(target);
      }
    }
    repeats_ = mostCommon(repeats);
  }

  std::vector<Remark> missing() const {
    std::vector<Remark> found;
    for (const auto& [pose, steps] : readings_) {
      for (const auto& [step, count] : poses_with_) {
        const auto has = steps.find(step);
        const std::string& name = campaign::poseName(campaign_, pose);
        if (has == steps.end()) {
          // A step that only some postures have is a choice, not a gap.
          if (2 * count > static_cast<int>(readings_.size()))
            found.push_back(Remark(RemarkId::step_not_read, name, step));
          continue;
        }
        describeState(name, step, has->second, found);
        if (!states_.contains({pose, step})) found.push_back(Remark(RemarkId::no_row_in_states, name, step));
      }
    }
    for (std::size_t pose = 0; pose < campaign_.pose_ids.size(); ++pose) {
      if (!readings_.contains(static_cast<int>(pose))) {
        found.push_back(Remark(RemarkId::posture_not_read, campaign_.pose_ids[pose]));
      }
    }
    return found;
  }

  std::size_t size() const { return readings_.size(); }

 private:
  /// Readings of one state mostly follow each other.
  void add(int pose, int step, int target) {
    if (last_ == nullptr || pose != last_pose_ || step != last_step_) {
      last_ = &readings_[pose][step];
      last_pose_ = pose, last_step_ = step;
    }
    ++(*last_)[target];
  }

  void describeState(const std::string& pose, int step, const std::map<int, int>& targets,
                     std::vector<Remark>& found) const {
    for (const int target : targets_) {
      const auto has = targets.find(target);
      const int count = has == targets.end() ? 0 : has->second;
      if (count >= repeats_) continue;
      found.push_back(
          Remark(RemarkId::too_few_readings, pose, step, count, repeats_, campaign::targetName(campaign_, target)));
    }
  }

  const campaign::Campaign& campaign_;
  std::map<int, std::map<int, std::map<int, int>>> readings_;  ///< pose, step, target: count
  std::map<int, int>* last_ = nullptr;                         ///< of `readings_`: of the state that was added to last
  int last_pose_ = 0, last_step_ = 0;
  std::set<std::pair<int, int>> states_;
  std::map<int, int> poses_with_;  ///< by step
  std::set<int> targets_;
  int repeats_ = 0;
};

/// The state, or the posture, in which something is missing.
Remark placeOf(const Remark& gap) {
  Remark place(gap.is(RemarkId::posture_not_read) ? RemarkId::at_pose : RemarkId::at_state);
  place.values.assign(gap.values.begin(), gap.values.begin() + (place.is(RemarkId::at_pose) ? 1 : 2));
  return place;
}

}  // namespace

Findings checkCompleteness(const AuditInput& input) {
  const campaign::Campaign& campaign = input.campaign;
  if (!campaign.states || (!campaign.loading && !campaign.displacements)) {
    return {preparation::notTestable("completeness", Remark(MissingId::no_load_states))};
  }
  const Inventory inventory(campaign);
  std::vector<Remark> missing = inventory.missing();
  preparation::AuditCheck check;
  check.id = "completeness";
  check.value = static_cast<double>(missing.size());
  check.limit = 0.0;
  check.limit_source = Remark(LimitId::what_most_have);
  check.message = Remark(RemarkId::all_there, inventory.size());
  if (missing.empty()) return {check};
  check.verdict = preparation::AuditVerdict::warn;
  check.where = placeOf(missing.front());
  check.message = Remark(RemarkId::missing, std::move(missing));
  return {check};
}

namespace {

struct Span {
  double first = INFINITY, last = -INFINITY;
  std::size_t line = 0;  ///< of its first row
};

/// Rows that come before the last one of an earlier step of their posture.
template <class Row>
std::vector<Remark> outOfOrder(const campaign::Campaign& campaign, const campaign::Table<Row>& table) {
  std::map<int, std::map<int, Span>> poses;
  const Row* last = nullptr;  // rows of one step mostly follow each other
  Span* last_span = nullptr;
  for (const Row& row : table.rows) {
    if (!std::isfinite(row.time_s)) continue;
    if (last == nullptr || row.pose != last->pose || row.step != last->step) last_span = &poses[row.pose][row.step];
    last = &row;
    Span& span = *last_span;
    if (row.time_s < span.first) span.first = row.time_s, span.line = row.line;
    span.last = std::max(span.last, row.time_s);
  }
  std::vector<Remark> found;
  for (const auto& [pose, steps] : poses) {
    const Span* before = nullptr;
    int step_before = 0;
    for (const auto& [step, span] : steps) {
      if (before != nullptr && span.first < before->last) {
        found.push_back(Remark(RemarkId::step_too_early, campaign::rowName(table.file, span.line),
                               campaign::poseName(campaign, pose), step, step_before));
      }
      before = &span;
      step_before = step;
    }
  }
  return found;
}

/// When the readings of each load state were taken.
using Spans = std::map<std::pair<int, int>, Span>;  // pose, step

Spans spansOf(const campaign::Table<campaign::LoadingReading>& loading) {
  Spans readings;
  const campaign::LoadingReading* last = nullptr;
  Span* last_span = nullptr;
  for (const campaign::LoadingReading& row : loading.rows) {
    if (last == nullptr || row.pose != last->pose || row.step != last->step)
      last_span = &readings[{row.pose, row.step}];
    last = &row;
    Span& span = *last_span;
    span.first = std::min(span.first, row.time_s);
    span.last = std::max(span.last, row.time_s);
  }
  return readings;
}

/// Load states whose row is older or younger than all readings of another step than its own; `ahead`: by how much the
/// rows' clock is ahead, s.
std::vector<Remark> statesApart(const campaign::Campaign& campaign, const Spans& readings, double ahead = 0.0) {
  std::vector<Remark> found;
  for (const campaign::State& state : campaign.states->rows) {
    const auto own = readings.find({state.pose, state.step});
    if (own == readings.end() || !std::isfinite(state.time_s)) continue;
    const double time = state.time_s - ahead;
    const auto end = readings.upper_bound({state.pose, std::numeric_limits<int>::max()});
    for (auto other = readings.lower_bound({state.pose, std::numeric_limits<int>::min()}); other != end; ++other) {
      const auto& [key, span] = *other;
      if (key.second == state.step) continue;
      const bool within = time > span.first && time < span.last;
      const bool beyond =
          (span.first > own->second.last && time >= span.first) || (span.last < own->second.first && time <= span.last);
      if (!within && !beyond) continue;
      found.push_back(Remark(RemarkId::state_during, campaign::rowName(campaign.states->file, state.line),
                             campaign::poseName(campaign, state.pose), state.step, key.second));
      break;
    }
  }
  return found;
}

/// By how much the clock of the states is ahead of that of the readings, s, where that alone puts `apart` right: whole
/// hours or minutes where they do, because clocks are set to other zones.
std::optional<double> clocksApart(const campaign::Campaign& campaign, const Spans& readings, std::size_t apart) {
  std::vector<double> ahead;
  double longest = 0.0;  // s, of a load state's readings
  for (const campaign::State& state : campaign.states->rows) {
    const auto own = readings.find({state.pose, state.step});
    if (own == readings.end() || !std::isfinite(state.time_s) || !std::isfinite(own->second.first)) continue;
    ahead.push_back(state.time_s - own->second.first);
    longest = std::max(longest, own->second.last - own->second.first);
  }
  constexpr std::size_t kEnough = 6;
  if (ahead.size() < kEnough || 2 * apart < ahead.size()) return std::nullopt;
  const double middle = numerics::upperMedian(ahead);
  constexpr double kMinute = 60.0, kHour = 3600.0;
  for (const double unit : {kHour, kMinute, 1.0}) {
    const double by = std::round(middle / unit) * unit;
    if (by == 0.0 || std::abs(by - middle) > std::max(1.0, longest)) continue;
    if (statesApart(campaign, readings, by).empty()) return by;
  }
  return std::nullopt;
}

/// Postures whose rows in `states` were taken while another one was read, each another: the rows' contents were moved
/// between postures, as where a table is sorted as text (1, 10, 11, 2) and numbered afresh.
struct MovedRows {
  std::size_t moved = 0, postures = 0;
  int pose = 0, during = 0;  ///< the first of them, and the one that was read then
  bool as_text = false;      ///< all are where sorting by names would have put them
};

template <class Row>
std::map<int, Span> spansOfPostures(const std::vector<Row>& rows) {
  std::map<int, Span> spans;
  auto at = spans.end();  // rows of one posture mostly follow each other
  for (const Row& row : rows) {
    if (at == spans.end() || at->first != row.pose) at = spans.try_emplace(row.pose).first;
    at->second.first = std::min(at->second.first, row.time_s);
    at->second.last = std::max(at->second.last, row.time_s);
  }
  return spans;
}

MovedRows movedRows(const campaign::Campaign& campaign) {
  MovedRows rows;
  if (!campaign.loading || !campaign.states) return rows;
  const std::map<int, Span> readings = spansOfPostures(campaign.loading->rows),
                            states = spansOfPostures(campaign.states->rows);
  std::vector<std::pair<double, int>> order;  // middle of the readings, posture
  for (const auto& [pose, span] : readings) {
    if (!std::isfinite(span.first) || !states.contains(pose) || !std::isfinite(states.at(pose).first)) return rows;
    order.emplace_back(0.5 * (span.first + span.last), pose);
  }
  constexpr std::size_t kEnough = 4;
  if (order.size() < kEnough) return rows;
  std::sort(order.begin(), order.end());
  const double apart = (order.back().first - order.front().first) / static_cast<double>(order.size() - 1);  // s
  std::vector<std::string> sorted;
  for (const auto& [time, pose] : order) sorted.push_back(campaign::poseName(campaign, pose));
  std::sort(sorted.begin(), sorted.end());
  rows.postures = order.size();
  rows.as_text = true;
  std::set<int> taken;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const int pose = order[i].second;
    const double time = 0.5 * (states.at(pose).first + states.at(pose).last);
    auto nearest = std::lower_bound(order.begin(), order.end(), std::pair(time, 0));
    const bool has_earlier = nearest != order.begin();
    if (nearest == order.end() || (has_earlier && time - std::prev(nearest)->first < nearest->first - time)) --nearest;
    if (std::abs(time - nearest->first) > apart) return {};  // of another clock
    taken.insert(nearest->second);
    rows.as_text &= campaign::poseName(campaign, nearest->second) == sorted[i];
    if (nearest->second == pose) continue;
    if (rows.moved++ == 0) rows.pose = pose, rows.during = nearest->second;
  }
  if (taken.size() != order.size() || 2 * rows.moved < order.size()) return {};
  return rows;
}

}  // namespace

bool statesOfOtherPostures(const AuditInput& input) { return movedRows(input.campaign).moved > 0; }

Findings checkTimeOrder(const AuditInput& input) {
  const campaign::Campaign& campaign = input.campaign;
  if (!campaign.states && !campaign.loading)
    return {preparation::notTestable("time_order", Remark(MissingId::no_states_nor_loading))};
  std::vector<Remark> found;
  if (campaign.loading) found = outOfOrder(campaign, *campaign.loading);
  if (campaign.states) {
    const auto states = outOfOrder(campaign, *campaign.states);
    found.insert(found.end(), states.begin(), states.end());
  }
  std::optional<double> ahead;
  if (campaign.loading && campaign.states && found.empty()) {
    const Spans readings = spansOf(*campaign.loading);
    found = statesApart(campaign, readings);
    if (!found.empty()) ahead = clocksApart(campaign, readings, found.size());
  }
  const MovedRows moved = movedRows(campaign);
  preparation::AuditCheck check;
  check.id = "time_order";
  check.value = static_cast<double>(std::max(found.size(), moved.moved));
  check.limit = 0.0;
  check.limit_source = Remark(LimitId::order_of_format);
  check.message = Remark(RemarkId::steps_follow);
  if (*check.value == 0.0) return {check};
  // What puts all of them right is said instead of them.
  if (moved.moved > 0) {
    found = {Remark(RemarkId::rows_of_other_postures, campaign.states->file, moved.moved, moved.postures,
                    campaign::poseName(campaign, moved.pose), campaign::poseName(campaign, moved.during),
                    moved.as_text)};
  } else if (ahead) {
    found = {Remark(RemarkId::clocks_apart, campaign.states->file, campaign.loading->file, *ahead, found.size())};
  }
  check.verdict = preparation::AuditVerdict::fail;
  check.where = Remark(preparation::RemarkId::at_name, std::get<std::string>(found.front().values.front()));
  check.message = Remark(RemarkId::steps_out_of_order, std::move(found));
  return {check};
}

}  // namespace stiffscope::audit
