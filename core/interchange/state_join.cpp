#include "core/interchange/state_join.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/interchange/day_files.h"
#include "core/io/input_error.h"
#include "core/io/units.h"

namespace stiffscope::interchange {

namespace {

using StateKey = std::tuple<int, std::string, int>;  ///< axis, pose, step

StateKey keyOf(const DayReading& reading) { return {reading.axis, reading.pose, reading.step}; }

std::string shownKey(const StateKey& key) {
  const auto& [axis, pose, step] = key;
  std::string text = axis < 0 ? "" : fmt::format("axis {}, ", axis + 1);
  text += "pose " + pose;
  return step == 0 ? text : text + fmt::format(", step {}", step);
}

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

/// The samples by what their names say; a log without steps has those of a pose for all its steps.
std::map<StateKey, std::size_t> samplesByName(const JoinTask& task) {
  std::map<StateKey, std::size_t> samples;
  const NamePattern& names = task.source.names;
  for (std::size_t i = 0; i < task.log.samples.size(); ++i) {
    const JointSample& sample = task.log.samples[i];
    const auto fields = names.fieldsIn(sample.name);
    if (!fields) continue;
    const auto field = [&](const char* name) {
      const auto found = fields->find(name);
      return found == fields->end() ? std::string() : found->second;
    };
    const int step = field("step").empty() ? sample.step : wholeStep(task.file, sample.line, field("step"));
    const int axis = field("axis").empty() ? sample.axis : wholeStep(task.file, sample.line, field("axis"));
    const std::string pose = names.has("index") ? field("index") : field("pose");
    const StateKey key{axis < 0 ? -1 : axis - 1, pose, std::max(step, 0)};
    const auto [first, added] = samples.emplace(key, i);
    // A table with a row for each reflector states the joints again.
    if (!added && sample.figures != task.log.samples[first->second].figures)
      throw io::InputError({task.file, sample.line, "pose"}, sample.name,
                           fmt::format("expected the same joints in all rows of {}; line {} has others", shownKey(key),
                                       task.log.samples[first->second].line));
  }
  return samples;
}

bool isTimed(const RobotLog& log) {
  return std::all_of(log.samples.begin(), log.samples.end(),
                     [](const JointSample& sample) { return sample.time_s.has_value(); });
}

void setJoints(JoinedState& state, const RobotLog& log, std::size_t first, std::size_t last) {
  state.first = first;
  state.last = last;
  state.figures = meanFigures(log.samples, first, last);
}

}  // namespace

StateJoin joinByName(const JoinTask& task, const std::vector<DayReading>& readings) {
  const std::map<StateKey, std::size_t> samples = samplesByName(task);
  StateJoin join{statesInOrder(readings), {}, {}, std::nullopt};
  for (const auto& [key, sample] : samples) join.stretches.emplace_back(sample, sample);
  for (JoinedState& state : join.states) {
    // By axis, pose and step, as far as the log tells them.
    auto found = samples.end();
    for (const StateKey& key : {StateKey{state.axis, state.pose, state.step}, StateKey{-1, state.pose, state.step},
                                StateKey{state.axis, state.pose, 0}, StateKey{-1, state.pose, 0}}) {
      if (found == samples.end()) found = samples.find(key);
    }
    if (found == samples.end()) {
      const DayReading& reading = readings[state.readings.front()];
      throw io::InputError({task.day.pathOf(task.day.points[reading.source].file), reading.line, "pose"}, state.pose,
                           fmt::format("expected a pose that {} has joints for", task.file));
    }
    setJoints(state, task.log, found->second, found->second);
  }
  return join;
}

StateJoin joinByOrder(const JoinTask& task, const std::vector<DayReading>& readings) {
  StateJoin join{statesInOrder(readings), {}, {}, std::nullopt};
  const std::size_t samples = task.log.samples.size(), wanted = join.states.size();
  if (samples == wanted) {
    for (std::size_t i = 0; i < wanted; ++i) setJoints(join.states[i], task.log, i, i);
    return join;
  }
  std::vector<Standstill> standstills;
  if (isTimed(task.log)) standstills = standstillsOf(task.log.samples, task.day.clock.standstill);
  if (standstills.size() != wanted) {
    throw io::InputError(
        {task.file, 0, "by"}, "order",
        fmt::format("expected as many postures in the log as were read, {}; it has {} rows{}", wanted, samples,
                    isTimed(task.log) ? fmt::format(" and {} standstills", standstills.size()) : ""));
  }
  for (std::size_t i = 0; i < wanted; ++i)
    setJoints(join.states[i], task.log, standstills[i].first, standstills[i].last);
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
    setJoints(state, task.log, first, last);
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
    return join;
  }
  join.states.reserve(samples.size());
  join.stretches.reserve(samples.size());
  if (std::all_of(samples.begin(), samples.end(), [](const JointSample& sample) { return sample.name.empty(); })) {
    for (std::size_t i = 0; i < samples.size(); ++i) add(std::to_string(i + 1), 0, i, i);
    return join;
  }
  for (const auto& [key, sample] : samplesByName(task)) {
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

namespace {

/// The standstill that a time of the robot's clock falls into, by the last digit of the reading's time; npos for none.
constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

std::size_t standstillAt(const std::vector<Standstill>& standstills, double time, double resolution) {
  const auto next = std::lower_bound(standstills.begin(), standstills.end(), time,
                                     [](const Standstill& still, double at) { return still.to_s < at; });
  // The one it is in, else the nearer of the two beside it.
  std::size_t nearest = kNowhere;
  double distance = resolution;
  for (auto one = next == standstills.begin() ? next : next - 1; one != standstills.end() && one <= next; ++one) {
    const double apart = std::max({one->from_s - time, time - one->to_s, 0.0});
    if (apart > distance || (nearest != kNowhere && apart == distance)) continue;
    nearest = static_cast<std::size_t>(one - standstills.begin());
    distance = apart;
  }
  return nearest;
}

/// Readings that name their pose keep it; others take the number of their standstill among those with readings.
struct ClockJoin {
  std::vector<std::size_t> standstill_of;  ///< of each reading
  std::vector<JoinedState> states;
};

ClockJoin joinedAt(const JoinTask& task, const std::vector<DayReading>& readings,
                   const std::vector<Standstill>& standstills, double offset) {
  ClockJoin join;
  std::vector<std::size_t> order;
  std::map<std::size_t, std::string> numbers;
  for (const DayReading& reading : readings) {
    const std::size_t still = standstillAt(standstills, reading.time_s + offset, reading.resolution_s);
    join.standstill_of.push_back(still);
    if (still != kNowhere) numbers.emplace(still, "");
  }
  std::size_t number = 0;
  for (auto& [still, name] : numbers) name = std::to_string(++number);
  std::map<std::tuple<std::size_t, int, std::string, int>, std::size_t> places;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const std::size_t still = join.standstill_of[i];
    if (still == kNowhere) continue;
    const DayReading& reading = readings[i];
    const std::string pose = reading.pose.empty() ? numbers.at(still) : reading.pose;
    const auto [place, added] = places.emplace(std::tuple(still, reading.axis, pose, reading.step), join.states.size());
    if (added) {
      JoinedState state;
      state.pose = pose;
      state.step = reading.step;
      state.axis = reading.axis;
      setJoints(state, task.log, standstills[still].first, standstills[still].last);
      join.states.push_back(std::move(state));
    }
    join.states[place->second].readings.push_back(i);
  }
  return join;
}

/// Where several load steps share a standstill each has the samples of its own readings' times, as far as there are
/// any: a servo gives way under load by more than its encoder's digits.
void narrowToReadings(const JoinTask& task, const std::vector<DayReading>& readings, double offset,
                      std::vector<JoinedState>& states) {
  std::map<std::size_t, int> sharing;
  for (const JoinedState& state : states) ++sharing[state.first];
  for (JoinedState& state : states) {
    if (sharing.at(state.first) < 2) continue;
    double from = std::numeric_limits<double>::infinity(), to = -from;
    for (const std::size_t i : state.readings) {
      from = std::min(from, readings[i].time_s + offset);
      to = std::max(to, readings[i].time_s + offset);
    }
    std::size_t first = state.first, last = state.last;
    while (first < last && *task.log.samples[first].time_s < from) ++first;
    while (last > first && *task.log.samples[last].time_s > to) --last;
    setJoints(state, task.log, first, last);
  }
}

/// A pose is one posture: its readings of one step in two standstills are two poses, or two clocks.
void requireOnePlaceAPose(const JoinTask& task, const std::vector<DayReading>& readings,
                          const std::vector<JoinedState>& states) {
  std::map<StateKey, const JoinedState*> seen;
  for (const JoinedState& state : states) {
    const auto [first, added] = seen.emplace(StateKey{state.axis, state.pose, state.step}, &state);
    if (added) continue;
    const DayReading& reading = readings[state.readings.front()];
    throw io::InputError({task.day.pathOf(task.day.points[reading.source].file), reading.line, "pose"}, state.pose,
                         fmt::format("expected the readings of a pose in one standstill; line {} is of another",
                                     readings[first->second->readings.front()].line));
  }
}

std::vector<ReadingTime> timesOf(const JoinTask& task, const std::vector<DayReading>& readings) {
  std::vector<ReadingTime> times;
  for (const DayReading& reading : readings) {
    if (!reading.hasTime())
      throw io::InputError({task.day.pathOf(task.day.points[reading.source].file), reading.line, "time"}, "",
                           "expected a time; without one the clock cannot say where the joints were");
    times.push_back({reading.time_s, reading.resolution_s});
  }
  return times;
}

std::optional<double> misfitAt(const JoinTask& task, const std::vector<DayReading>& readings,
                               const std::vector<Standstill>& standstills, double offset) {
  const ClockJoin join = joinedAt(task, readings, standstills, offset);
  return chordMisfit(task.robot, task.day.xml.campaign.joint_readings, placedReadings(join.states, readings));
}

std::string shownOffset(const ClockOffset& offset) {
  return fmt::format("{:.3f} +- {:.3f} s", offset.offset_s, offset.uncertainty_s);
}

/// Of several offsets the one by which distances agree.
ClockOffset chosenOffset(const JoinTask& task, const std::vector<DayReading>& readings,
                         const std::vector<Standstill>& standstills, const std::vector<ClockOffset>& offsets,
                         std::optional<double>& misfit) {
  const auto refuse = [&](const std::string& why) {
    throw io::InputError({task.day.file, task.source.line, "by"}, "clock",
                         "expected one offset of the two clocks; " + why);
  };
  if (offsets.empty() || 2 * offsets.front().inside < readings.size()) {
    refuse(fmt::format("none puts half of the {} readings into the {} standstills of {}", readings.size(),
                       standstills.size(), task.source.file));
  }
  std::vector<std::pair<double, std::size_t>> fits;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const auto fit = misfitAt(task, readings, standstills, offsets[i].offset_s);
    if (fit) fits.emplace_back(*fit, i);
  }
  std::sort(fits.begin(), fits.end());
  if (offsets.size() == 1) {
    if (!fits.empty()) misfit = fits.front().first;
    return offsets.front();
  }
  if (fits.size() < 2)
    refuse(fmt::format(
        "{} puts {} of {} readings into standstills, {} {}, and too few postures are there to tell by "
        "distances: state it (offset_s)",
        shownOffset(offsets[0]), offsets[0].inside, readings.size(), shownOffset(offsets[1]), offsets[1].inside));
  constexpr double kClearly = 2.0;
  if (fits[1].first < kClearly * fits[0].first) {
    const ClockJoin join = joinedAt(task, readings, standstills, offsets.front().offset_s);
    requireMeaning(task, placedReadings(join.states, readings), fits[0].first);
    refuse(
        fmt::format("{} and {} serve alike, and distances between the reflectors' places are off by {:.1f} mm and "
                    "{:.1f} mm: state it (offset_s)",
                    shownOffset(offsets[fits[0].second]), shownOffset(offsets[fits[1].second]), 1e3 * fits[0].first,
                    1e3 * fits[1].first));
  }
  misfit = fits.front().first;
  return offsets[fits.front().second];
}

std::size_t insideBy(const std::vector<ReadingTime>& times, const std::vector<Standstill>& standstills, double offset) {
  return static_cast<std::size_t>(std::count_if(times.begin(), times.end(), [&](const ReadingTime& time) {
    return standstillAt(standstills, time.seconds + offset, time.resolution) != kNowhere;
  }));
}

/// Offsets without those by which clearly more readings were taken in motion than by the first. Nobody reads a moving
/// reflector often; readings before or behind the log contradict nothing.
std::vector<ClockOffset> notInMotion(const JoinTask& task, const std::vector<ReadingTime>& times,
                                     const std::vector<Standstill>& standstills, std::vector<ClockOffset> offsets) {
  if (offsets.empty()) return offsets;
  constexpr double kShare = 0.02;
  constexpr std::size_t kFew = 3;
  const double begin = *task.log.samples.front().time_s, end = *task.log.samples.back().time_s;
  const auto inMotion = [&](const ClockOffset& offset) {
    return static_cast<std::size_t>(std::count_if(times.begin(), times.end(), [&](const ReadingTime& time) {
      const double at = time.seconds + offset.offset_s;
      return at >= begin && at <= end && standstillAt(standstills, at, time.resolution) == kNowhere;
    }));
  };
  const std::size_t allowed =
      inMotion(offsets.front()) + std::max(kFew, static_cast<std::size_t>(kShare * static_cast<double>(times.size())));
  std::erase_if(offsets, [&](const ClockOffset& offset) { return inMotion(offset) > allowed; });
  return offsets;
}

/// An offset that was stated must put nearly as many readings into standstills as the best does.
void requireStatedServes(const JoinTask& task, const std::vector<ReadingTime>& times,
                         const std::vector<Standstill>& standstills, const std::vector<ClockOffset>& offsets) {
  constexpr double kNearly = 0.9;
  const std::size_t inside = insideBy(times, standstills, *task.day.clock.offset_s);
  if (offsets.empty() || static_cast<double>(inside) >= kNearly * static_cast<double>(offsets.front().inside)) return;
  throw io::InputError(
      {task.day.file, task.source.line, "offset_s"}, fmt::format("{:g}", *task.day.clock.offset_s),
      fmt::format(
          "expected an offset that puts the readings into standstills of the joints; this one does of {} of {}, "
          "{} of {}",
          inside, times.size(), shownOffset(offsets.front()), offsets.front().inside));
}

}  // namespace

StateJoin joinByClock(const JoinTask& task, const std::vector<DayReading>& readings) {
  if (!isTimed(task.log))
    throw io::InputError({task.file, 0, "time"}, "", "expected a log with times, or its rate (rate_hz)");
  const std::vector<ReadingTime> times = timesOf(task, readings);
  const std::vector<Standstill> standstills = standstillsOf(task.log.samples, task.day.clock.standstill);
  constexpr double kShare = 0.8;
  const std::vector<ClockOffset> offsets =
      notInMotion(task, times, standstills, possibleOffsets(times, standstills, kShare));
  ClockReport report;
  report.log = task.source.file;
  report.readings = readings.size();
  report.standstills = standstills.size();
  if (task.day.clock.offset_s) {
    requireStatedServes(task, times, standstills, offsets);
    report.stated = true;
    report.offset_s = *task.day.clock.offset_s;
    report.misfit = misfitAt(task, readings, standstills, report.offset_s);
  } else {
    const ClockOffset chosen = chosenOffset(task, readings, standstills, offsets, report.misfit);
    report.offset_s = chosen.offset_s;
    report.uncertainty_s = chosen.uncertainty_s;
  }
  report.inside = insideBy(times, standstills, report.offset_s);
  ClockJoin join = joinedAt(task, readings, standstills, report.offset_s);
  StateJoin joined{std::move(join.states), {}, {}, report};
  for (const Standstill& still : standstills) joined.stretches.emplace_back(still.first, still.last);
  narrowToReadings(task, readings, report.offset_s, joined.states);
  requireOnePlaceAPose(task, readings, joined.states);
  const double begin = *task.log.samples.front().time_s, end = *task.log.samples.back().time_s;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (join.standstill_of[i] != kNowhere) continue;
    const double time = times[i].seconds + report.offset_s;
    joined.left_out.emplace_back(i, time < begin || time > end ? Skip::outside_log : Skip::in_motion);
  }
  return joined;
}

}  // namespace stiffscope::interchange
