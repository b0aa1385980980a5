#include "core/interchange/state_join.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/interchange/day_files.h"
#include "core/interchange/state_samples.h"
#include "core/io/input_error.h"

namespace stiffscope::interchange {

namespace {

StateKey keyOf(const DayReading& reading) { return {reading.axis, reading.pose, reading.step}; }

/// States in the order in which they were first read.
std::vector<JoinedState> statesInOrder(const std::vector<DayReading>& readings) {
  std::map<StateKey, std::size_t> places;
  for (const DayReading& reading : readings) places.emplace(keyOf(reading), places.size());
  // Of a million states doubling would take three times their room.
  std::vector<JoinedState> states;
  states.reserve(places.size());
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const std::size_t place = places.at(keyOf(readings[i]));
    if (place == states.size()) {
      JoinedState state;
      state.pose = readings[i].pose;
      state.step = readings[i].step;
      state.axis = readings[i].axis;
      states.push_back(std::move(state));
    }
    states[place].readings.push_back(i);
  }
  return states;
}

/// What two samples of one pose and step have differently; empty where they say the same as far as it is taken.
std::string difference(const JoinTask& task, std::size_t a, std::size_t b) {
  const RobotLog& log = task.log;
  const JointSample &one = log.samples[a], &other = log.samples[b];
  const auto differ = [](const auto& x, const auto& y) {
    return ((x.array() != y.array()) && !(x.array().isNaN() && y.array().isNaN())).any();
  };
  if (differ(one.figures, other.figures)) return "joints";
  if (task.role != Role::loading) return {};
  if (takesWrench(task) && differ(one.wrench, other.wrench)) return "wrench";
  const bool no_temperature = std::isnan(one.temperature_c) && std::isnan(other.temperature_c);
  if (one.temperature_c != other.temperature_c && !no_temperature) return "temperature";
  if (differ(one.tool_pose.position, other.tool_pose.position) || differ(one.tool_pose.rpy, other.tool_pose.rpy))
    return "pose of the tool";
  if (!log.motor_side.empty() && differ(log.motor_side[a], log.motor_side[b])) return "angles of the motors' side";
  if (!log.commanded.empty() && differ(log.commanded[a], log.commanded[b])) return "commanded angles";
  return {};
}

struct NamedSamples {
  std::map<StateKey, std::size_t> first;  ///< by what their names say
  std::vector<std::size_t> merged;        ///< say the same as the first of their name
  bool steps = false;                     ///< some name a step; else a pose's hold for all its steps
};

NamedSamples samplesByName(const JoinTask& task) {
  NamedSamples named;
  const NamePattern& names = task.source.names;
  const bool sweep = task.role != Role::loading, by_index = sweep && !task.log.index.empty();
  // A row's number in a table of states is none of its pose; in a sweep it is what tells rows apart.
  const bool index_first = sweep ? names.has("index") : !names.has("pose") && names.has("index");
  for (std::size_t i = 0; i < task.log.samples.size(); ++i) {
    const JointSample& sample = task.log.samples[i];
    const std::string& name = by_index ? task.log.index[i] : sample.name;
    const auto fields = names.fieldsIn(name);
    if (!fields) continue;
    const auto field = [&](const char* of) {
      const auto found = fields->find(of);
      return found == fields->end() ? std::string() : found->second;
    };
    const int step = field("step").empty() ? sample.step : wholeStep(task.file, sample.line, field("step"));
    const int axis = field("axis").empty() ? sample.axis : wholeStep(task.file, sample.line, field("axis"));
    const StateKey key{axis < 0 ? -1 : axis - 1, field(index_first ? "index" : "pose"), std::max(step, 0)};
    named.steps = named.steps || step >= 0;
    const auto [first, added] = named.first.emplace(key, i);
    if (added) continue;
    // A table with a row for each reflector states the joints again.
    const std::string what = difference(task, first->second, i);
    if (!what.empty())
      throw io::InputError({task.file, sample.line, "pose"}, name,
                           fmt::format("expected the same {} in all rows of {}; line {} differs{}", what, shownKey(key),
                                       task.log.samples[first->second].line,
                                       step < 0 ? ": a column step tells load states of a pose apart" : ""));
    named.merged.push_back(i);
  }
  return named;
}

/// The sample of a state; throws InputError where there is none. A log that names steps has none for another step: at
/// step 0 the joints, and what the load cell reads, are those of the unloaded arm.
std::size_t sampleOf(const JoinTask& task, const NamedSamples& named, const JoinedState& state,
                     const DayReading& reading) {
  // By axis, pose and step, as far as the log tells them.
  const auto at = [&](int step) {
    const auto found = named.first.find({state.axis, state.pose, step});
    return found != named.first.end() ? found : named.first.find({-1, state.pose, step});
  };
  const auto own = at(state.step);
  if (own != named.first.end()) return own->second;
  const auto unloaded = at(0);
  if (!named.steps && unloaded != named.first.end()) return unloaded->second;
  const std::string file = task.day.pathOf(task.day.points[reading.source].file);
  const bool posed = std::any_of(named.first.begin(), named.first.end(), [&](const auto& one) {
    const auto& [axis, pose, step] = one.first;
    return pose == state.pose && (axis == -1 || axis == state.axis);
  });
  if (!posed)
    throw io::InputError({file, reading.line, "pose"}, state.pose,
                         fmt::format("expected a pose that {} has joints for", task.file));
  throw io::InputError({file, reading.line, "step"}, std::to_string(state.step),
                       fmt::format("expected a step of pose {} that {} has a row of; joints and wrench of another step "
                                   "are not those of this one",
                                   state.pose, task.file));
}

/// What a load changes is of one step: throws InputError where two steps would take it from one sample.
void requireOwnLoads(const JoinTask& task, const std::vector<DayReading>& readings,
                     const std::vector<JoinedState>& states) {
  if (task.role != Role::loading || (!takesWrench(task) && task.log.motor_side.empty())) return;
  std::map<std::size_t, int> steps;
  for (const JoinedState& state : states) {
    const auto [first, added] = steps.emplace(state.first, state.step);
    if (added || first->second == state.step) continue;
    const DayReading& reading = readings[state.readings.front()];
    throw io::InputError(
        {task.day.pathOf(task.day.points[reading.source].file), reading.line, "step"}, std::to_string(state.step),
        fmt::format("expected a row of its own for each step of pose {} in {}; line {} names no step, and has {} that "
                    "would be those of step {}, too: a column step tells them apart",
                    state.pose, task.file, task.log.samples[state.first].line,
                    takesWrench(task) ? "force and moment" : "angles of the motors' side", first->second));
  }
}

/// States that are whole standstills: nobody says when in them the reflectors were read.
void requireSteady(const JoinTask& task, const std::vector<JoinedState>& states, const std::string& hint) {
  if (!takesWrench(task)) return;
  const WrenchSteadiness steadiness(task);
  for (const JoinedState& state : states) requireSteadyWrench(task, steadiness, state, hint);
}

bool wasNotRead(const JoinedState& state) { return state.readings.empty(); }

/// Postures of lost beams alone have had their row of the log, and are none of the table.
void leaveUnreadOut(StateJoin& join) {
  for (const JoinedState& state : join.states) {
    if (wasNotRead(state)) join.stretches.emplace_back(state.first, state.last);
  }
  std::erase_if(join.states, wasNotRead);
}

}  // namespace

StateJoin joinByName(const JoinTask& task, const std::vector<DayReading>& readings) {
  NamedSamples named = samplesByName(task);
  StateJoin join{statesInOrder(readings), {}, {}, std::nullopt};
  for (const auto& [key, sample] : named.first) join.stretches.emplace_back(sample, sample);
  for (JoinedState& state : join.states) {
    const std::size_t sample = sampleOf(task, named, state, readings[state.readings.front()]);
    setSamples(state, task.log, sample, sample);
  }
  requireOwnLoads(task, readings, join.states);
  join.merged = std::move(named.merged);
  return join;
}

StateJoin joinByOrder(const JoinTask& task, const std::vector<DayReading>& readings) {
  StateJoin join{statesInKnownOrder(task, readings), {}, {}, std::nullopt};
  const std::size_t samples = task.log.samples.size(), wanted = join.states.size();
  if (samples == wanted) {
    for (std::size_t i = 0; i < wanted; ++i) setSamples(join.states[i], task.log, i, i);
    leaveUnreadOut(join);
    return join;
  }
  std::vector<Standstill> standstills;
  if (isTimed(task.log)) standstills = standstillsOf(task.log.samples, task.day.clock.standstill);
  if (standstills.size() != wanted) {
    const auto unread = std::count_if(join.states.begin(), join.states.end(), wasNotRead);
    throw io::InputError(
        {task.file, 0, "by"}, "order",
        fmt::format("expected as many postures in the log as were read, {}{}; it has {} rows{}", wanted,
                    unread > 0 ? fmt::format(", {} of them by lost beams alone", unread) : "", samples,
                    isTimed(task.log) ? fmt::format(" and {} standstills", standstills.size()) : ""));
  }
  for (std::size_t i = 0; i < wanted; ++i)
    setSamples(join.states[i], task.log, standstills[i].first, standstills[i].last);
  leaveUnreadOut(join);
  requireSteady(task, join.states, "joined by the clock a state has what the cell read when its reflectors were");
  return join;
}

StateJoin joinNothing(const std::vector<DayReading>& readings) {
  return {statesInOrder(readings), {}, {}, std::nullopt};
}

StateJoin posturesOf(const JoinTask& task) {
  StateJoin join;
  const auto add = [&](std::string pose, int step, std::size_t first, std::size_t last) {
    JoinedState state;
    state.pose = std::move(pose);
    state.step = step;
    setSamples(state, task.log, first, last);
    join.states.push_back(std::move(state));
    join.stretches.emplace_back(first, last);
  };
  const std::vector<JointSample>& samples = task.log.samples;
  if (task.source.every_s) {
    if (!isTimed(task.log))
      throw io::InputError({task.day.file, task.source.line, "every_s"}, fmt::format("{:g}", *task.source.every_s),
                           "expected no such attribute of a log without times (rate_hz)");
    double next = *samples.front().time_s;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (*samples[i].time_s < next) continue;
      add(std::to_string(join.states.size() + 1), 0, i, i);
      next += *task.source.every_s * (std::floor((*samples[i].time_s - next) / *task.source.every_s) + 1.0);
    }
    return join;
  }
  if (isTimed(task.log)) {
    for (const Standstill& still : standstillsOf(task.log.samples, task.day.clock.standstill))
      add(std::to_string(join.states.size() + 1), 0, still.first, still.last);
    if (join.states.empty())
      throw io::InputError(
          {task.day.file, task.source.line, "log"}, task.source.file,
          "expected a log in which the joints stand still somewhere (still_deg, shortest_s), or every_s");
    requireSteady(task, join.states, "with every_s each posture is one sample");
    return join;
  }
  join.states.reserve(samples.size());
  join.stretches.reserve(samples.size());
  if (std::all_of(samples.begin(), samples.end(), [](const JointSample& sample) { return sample.name.empty(); })) {
    for (std::size_t i = 0; i < samples.size(); ++i) add(std::to_string(i + 1), 0, i, i);
    return join;
  }
  NamedSamples named = samplesByName(task);
  join.merged = std::move(named.merged);
  for (const auto& [key, sample] : named.first) {
    const auto& [axis, pose, step] = key;
    add(pose.empty() ? std::to_string(sample + 1) : pose, step, sample, sample);
  }
  // In the order of the log, not of names.
  std::sort(join.states.begin(), join.states.end(),
            [](const JoinedState& a, const JoinedState& b) { return a.first < b.first; });
  if (join.states.empty())
    throw io::InputError({task.day.file, task.source.line, "names"}, task.source.file,
                         "expected rows or targets whose names fit the pattern; there are none");
  return join;
}

std::vector<PlacedReading> placedReadings(const std::vector<JoinedState>& states,
                                          const std::vector<DayReading>& readings) {
  std::vector<PlacedReading> placed;
  for (const JoinedState& state : states) {
    std::vector<int> seen;
    for (const std::size_t i : state.readings) {
      const DayReading& reading = readings[i];
      if (std::find(seen.begin(), seen.end(), reading.target) != seen.end()) continue;
      seen.push_back(reading.target);
      placed.push_back({state.figures, reading.target, reading.point});
    }
  }
  return placed;
}

}  // namespace stiffscope::interchange
