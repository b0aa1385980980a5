#include "core/interchange/state_join.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "core/interchange/state_samples.h"
#include "core/io/input_error.h"

namespace stiffscope::interchange {

namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);
constexpr const char* kOtherWays = "; join by the name, or by the clock, where a row may be missing";

/// A row of a file of points: a reading, or a lost beam.
struct Row {
  const DayReading* said = nullptr;
  std::size_t reading = kNone;  ///< its place among the readings; kNone of a lost beam
  std::size_t state = 0;        ///< its place among the states as they first stand
};

std::string shown(const DayReading& row) { return shownKey({row.axis, row.pose, row.step}); }

std::string fileOf(const JoinTask& task, const DayReading& row) {
  return task.day.pathOf(task.day.points[row.source].file);
}

std::string placeOf(const JoinTask& task, const DayReading& row) {
  return fmt::format("{} line {}", fileOf(task, row), row.line);
}

[[noreturn]] void refuse(const JoinTask& task, const DayReading& row, const std::string& expected) {
  throw io::InputError({fileOf(task, row), row.line, "pose"}, row.pose, expected + kOtherWays);
}

/// States in the order in which a file, or a reflector of it, first has them.
class FirstVisits {
 public:
  explicit FirstVisits(const JoinTask& task) : task_(task) {}

  /// Rows may come back to states: to a reference posture, or all once more. Throws InputError where such a round has a
  /// new state between two that followed one another before: then it was passed over there, and where is not known.
  void add(const Row& row) {
    if (row.state == last_) return;
    last_ = row.state;
    const auto [at, added] = places_.emplace(row.state, Place{first_.size(), round_});
    if (added) {
      first_.push_back(row);
      if (round_ > 0 && new_since_ == kNone) new_since_ = at->second.place;
      return;
    }
    Place& known = at->second;
    if (known.round == round_)
      ++round_;
    else if (new_since_ != kNone && known.place == before_ + 1)
      refuse(task_, *first_[new_since_].said,
             fmt::format("expected this pose in the first round, too: here it stands between {} and {}, which followed "
                         "one another in {}",
                         shown(*first_[before_].said), shown(*first_[known.place].said),
                         placeOf(task_, *first_[known.place].said)));
    new_since_ = kNone;
    known.round = round_, before_ = known.place;
  }

  std::size_t size() const { return first_.size(); }
  const Row& operator[](std::size_t place) const { return first_[place]; }
  /// Where a state stands; kNone where it has none.
  std::size_t placeOfState(std::size_t state) const {
    const auto found = places_.find(state);
    return found == places_.end() ? kNone : found->second.place;
  }

 private:
  struct Place {
    std::size_t place = 0, round = 0;
  };

  const JoinTask& task_;
  std::vector<Row> first_;  ///< the first row of each state
  std::unordered_map<std::size_t, Place> places_;
  std::size_t round_ = 0, last_ = kNone;
  std::size_t before_ = kNone;     ///< place of the last state of this round that an earlier one has
  std::size_t new_since_ = kNone;  ///< place of the first one since then that no earlier one has
};

/// Whether most states of several reflectors have them side by side: the file was written posture by posture, not
/// reflector by reflector.
bool isPostureByPosture(const std::vector<Row>& rows, std::size_t begin, std::size_t end) {
  struct Seen {
    int target = -1, visited = -1;  ///< the first of all rows, and of this visit
    bool several = false, together = false;
  };
  std::unordered_map<std::size_t, Seen> states;
  for (std::size_t i = begin; i < end; ++i) {
    const int target = rows[i].said->target;
    Seen& seen = states[rows[i].state];
    if (seen.target < 0) seen.target = target;
    if (i == begin || rows[i - 1].state != rows[i].state) seen.visited = target;
    seen.several = seen.several || seen.target != target;
    seen.together = seen.together || seen.visited != target;
  }
  const auto count = [&](bool Seen::*what) {
    return std::count_if(states.begin(), states.end(), [&](const auto& one) { return one.second.*what; });
  };
  return 2 * count(&Seen::together) >= count(&Seen::several);
}

/// The parts of the order that one file shows.
void addPartsOf(const JoinTask& task, const std::vector<Row>& rows, std::size_t begin, std::size_t end,
                std::vector<FirstVisits>& parts) {
  const bool whole = isPostureByPosture(rows, begin, end);
  std::map<std::pair<int, std::string>, std::size_t> own;
  for (std::size_t i = begin; i < end; ++i) {
    const DayReading& said = *rows[i].said;
    const auto key = whole ? std::pair<int, std::string>() : std::pair(said.target, said.repeat);
    const auto [part, added] = own.emplace(key, parts.size());
    if (added) parts.emplace_back(task);
    parts[part->second].add(rows[i]);
  }
}

/// Puts parts of an order together.
class OrderMerge {
 public:
  OrderMerge(const JoinTask& task, const std::vector<FirstVisits>& parts, std::size_t states)
      : task_(task), parts_(parts), parts_of_(states), heads_(states), next_(parts.size()), group_(states) {
    std::iota(group_.begin(), group_.end(), std::size_t{0});
    for (std::size_t p = 0; p < parts.size(); ++p) {
      for (std::size_t i = 0; i < parts[p].size(); ++i) {
        parts_of_[parts[p][i].state].push_back(p);
        join(parts[p][0].state, parts[p][i].state);
      }
    }
  }

  /// Places of the states. Groups that share no file follow one another by their first states.
  std::vector<std::size_t> merged() {
    std::map<std::size_t, std::vector<std::size_t>> groups;
    for (std::size_t p = 0; p < parts_.size(); ++p) groups[rootOf(parts_[p][0].state)].push_back(p);
    for (const auto& [first, parts] : groups) mergeGroup(parts);
    return std::move(order_);
  }

 private:
  std::size_t rootOf(std::size_t state) {
    while (group_[state] != state) state = group_[state] = group_[group_[state]];
    return state;
  }

  void join(std::size_t a, std::size_t b) {
    const std::size_t one = rootOf(a), other = rootOf(b);
    group_[std::max(one, other)] = std::min(one, other);
  }

  /// A state is next where it is so in all parts that have it.
  void mergeGroup(const std::vector<std::size_t>& parts) {
    std::vector<std::size_t> ready;
    const auto arrive = [&](std::size_t part) {
      if (next_[part] == parts_[part].size()) return;
      const std::size_t state = parts_[part][next_[part]].state;
      if (++heads_[state] == parts_of_[state].size()) ready.push_back(state);
    };
    for (const std::size_t part : parts) arrive(part);
    while (!ready.empty()) {
      if (ready.size() > 1) refuseOpen(ready[0], ready[1]);
      const std::size_t state = ready.back();
      ready.pop_back();
      order_.push_back(state);
      for (const std::size_t part : parts_of_[state]) {
        ++next_[part];
        arrive(part);
      }
    }
    for (const std::size_t part : parts) {
      if (next_[part] < parts_[part].size()) refuseContradiction(parts);
    }
  }

  const DayReading& firstRowOf(std::size_t state) const {
    const FirstVisits& part = parts_[parts_of_[state].front()];
    return *part[part.placeOfState(state)].said;
  }

  [[noreturn]] void refuseOpen(std::size_t a, std::size_t b) const {
    const DayReading &one = firstRowOf(a), &other = firstRowOf(b);
    refuse(task_, other,
           fmt::format("expected a reflector that was read in this pose and in {} ({}), too: nothing says which of the "
                       "two came first, and order is all that says which row of {} is whose",
                       shown(one), placeOf(task_, one), task_.file));
  }

  /// Of two parts that have two states the other way round, else of those at which the parts stop.
  [[noreturn]] void refuseContradiction(const std::vector<std::size_t>& parts) const {
    constexpr const char* kOneOrder = "expected poses in one order of all reflectors and files";
    for (const std::size_t p : parts) {
      if (next_[p] == parts_[p].size()) continue;
      const Row& head = parts_[p][next_[p]];
      for (const std::size_t q : parts_of_[head.state]) {
        if (parts_[q][next_[q]].state == head.state) continue;
        const Row& ahead = parts_[q][next_[q]];
        const std::size_t behind = parts_[p].placeOfState(ahead.state);
        if (behind == kNone) continue;
        const Row& here = parts_[q][parts_[q].placeOfState(head.state)];
        refuse(task_, *here.said,
               fmt::format("{}: here it comes behind {} (line {}), but before it in {}", kOneOrder, shown(*ahead.said),
                           ahead.said->line, placeOf(task_, *head.said)));
      }
    }
    const auto open =
        std::find_if(parts.begin(), parts.end(), [&](std::size_t p) { return next_[p] < parts_[p].size(); });
    refuse(task_, *parts_[*open][next_[*open]].said,
           std::string(kOneOrder) +
               ": others have poses before this one "
               "that come behind it here");
  }

  const JoinTask& task_;
  const std::vector<FirstVisits>& parts_;
  std::vector<std::vector<std::size_t>> parts_of_;  ///< by state, the parts that have it
  std::vector<std::size_t> heads_;                  ///< by state, in how many of them it is the next
  std::vector<std::size_t> next_;                   ///< by part
  std::vector<std::size_t> group_;                  ///< by state, another one of the same group, or itself
  std::vector<std::size_t> order_;
};

}  // namespace

std::vector<JoinedState> statesInKnownOrder(const JoinTask& task, const std::vector<DayReading>& readings) {
  std::vector<Row> rows;
  rows.reserve(readings.size() + task.lost.size());
  for (std::size_t i = 0; i < readings.size(); ++i) rows.push_back({&readings[i], i});
  for (const DayReading& lost : task.lost) rows.push_back({&lost});
  std::inplace_merge(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(readings.size()), rows.end(),
                     [](const Row& a, const Row& b) {
                       return std::pair(a.said->source, a.said->line) < std::pair(b.said->source, b.said->line);
                     });
  std::map<StateKey, std::size_t> keys;
  for (Row& row : rows)
    row.state = keys.emplace(StateKey{row.said->axis, row.said->pose, row.said->step}, keys.size()).first->second;
  std::vector<FirstVisits> parts;
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    while (end < rows.size() && rows[end].said->source == rows[begin].said->source) ++end;
    addPartsOf(task, rows, begin, end, parts);
  }
  const std::vector<std::size_t> order = OrderMerge(task, parts, keys.size()).merged();
  std::vector<std::size_t> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  std::vector<JoinedState> states(order.size());
  for (const auto& [key, state] : keys)
    std::tie(states[place[state]].axis, states[place[state]].pose, states[place[state]].step) = key;
  for (const Row& row : rows) {
    if (row.reading != kNone) states[place[row.state]].readings.push_back(row.reading);
  }
  return states;
}

}  // namespace stiffscope::interchange
