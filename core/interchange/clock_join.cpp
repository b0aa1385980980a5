#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "core/interchange/state_join.h"
#include "core/interchange/state_samples.h"
#include "core/io/input_error.h"

namespace stiffscope::interchange {

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
      setSamples(state, task.log, standstills[still].first, standstills[still].last);
      join.states.push_back(std::move(state));
    }
    join.states[place->second].readings.push_back(i);
  }
  return join;
}

/// Samples of a state by the times of its readings, and to either side of them; one at least.
void setSamplesAround(JoinedState& state, const JoinTask& task, const std::vector<DayReading>& readings, double offset,
                      double margin, std::size_t still_first, std::size_t still_last) {
  double from = std::numeric_limits<double>::infinity(), to = -from;
  for (const std::size_t i : state.readings) {
    from = std::min(from, readings[i].time_s + offset - margin);
    to = std::max(to, readings[i].time_s + offset + margin);
  }
  const auto begin = task.log.samples.begin();
  const auto at = [&](std::size_t sample) { return begin + static_cast<std::ptrdiff_t>(sample); };
  const auto first = std::partition_point(at(still_first), at(still_last),
                                          [&](const JointSample& sample) { return *sample.time_s < from; });
  const auto last = std::partition_point(first + 1, at(still_last) + 1,
                                         [&](const JointSample& sample) { return *sample.time_s <= to; });
  setSamples(state, task.log, static_cast<std::size_t>(first - begin), static_cast<std::size_t>(last - begin) - 1);
}

/// Where several load steps share a standstill each has the samples of its own readings' times, as far as there are
/// any: a servo gives way under load by more than its encoder's digits. So has a single one where the log has what a
/// load changes at once, as it may have been put on within the standstill. As long as the wrench stays as it is, what
/// the times leave open is added: more samples scatter less. Throws InputError where it changes between the readings.
void narrowToReadings(const JoinTask& task, const std::vector<DayReading>& readings, const ClockReport& clock,
                      StateJoin& join) {
  std::map<std::size_t, int> sharing;
  for (const JoinedState& state : join.states) ++sharing[state.first];
  std::optional<WrenchSteadiness> steadiness;
  if (takesWrench(task)) steadiness.emplace(task);
  const bool loaded = steadiness || (task.role == Role::loading && !task.log.motor_side.empty());
  std::size_t open = 0;
  const JoinedState* first_open = nullptr;
  for (JoinedState& state : join.states) {
    const bool shared = sharing.at(state.first) > 1;
    if (!shared && !loaded) continue;
    const std::size_t first = state.first, last = state.last;
    if (steadiness) {
      double resolution = 0.0;
      for (const std::size_t i : state.readings) resolution = std::max(resolution, readings[i].resolution_s);
      // The steps beside are nearer than clocks are known; they tell the offset better than its bounds.
      const double margin = shared ? resolution : resolution + clock.uncertainty_s;
      setSamplesAround(state, task, readings, clock.offset_s, margin, first, last);
      const bool steady = !steadiness->changeIn(state.first, state.last);
      if (steady && !shared) continue;
      if (!steady && open++ == 0) first_open = &state;
    }
    setSamplesAround(state, task, readings, clock.offset_s, 0.0, first, last);
    if (steadiness)
      requireSteadyWrench(task, *steadiness, state,
                          "is the offset of the clocks right (offset_s), has each load a step of its own?");
  }
  if (open == 0) return;
  join.warnings.push_back(io::inputMessage(
      {task.file, task.log.samples[first_open->first].line, "fx to mz"}, "",
      fmt::format("the wrench changes close to the readings of {} states, first of {}: the digits of their times and "
                  "the clocks' offset (+- {:.3f} s) leave open which were before; taken as the times say",
                  open, shownKey({first_open->axis, first_open->pose, first_open->step}), clock.uncertainty_s)));
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

/// How far distances between the reflectors' places are off by an offset, m, and its place among all.
using OffsetMisfit = std::pair<double, std::size_t>;

/// The least first; without offsets by which too few postures were read to tell.
std::vector<OffsetMisfit> misfitsBy(const JoinTask& task, const std::vector<DayReading>& readings,
                                    const std::vector<Standstill>& standstills,
                                    const std::vector<ClockOffset>& offsets) {
  std::vector<OffsetMisfit> fits;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const auto fit = misfitAt(task, readings, standstills, offsets[i].offset_s);
    if (fit) fits.emplace_back(*fit, i);
  }
  std::sort(fits.begin(), fits.end());
  return fits;
}

/// Whether distances tell the first from all others.
bool isDecided(const std::vector<OffsetMisfit>& fits) {
  constexpr double kClearly = 2.0;
  return fits.size() == 1 || (fits.size() > 1 && fits[1].first >= kClearly * fits[0].first);
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
  const std::vector<OffsetMisfit> fits = misfitsBy(task, readings, standstills, offsets);
  if (offsets.size() == 1) {
    if (!fits.empty()) misfit = fits.front().first;
    return offsets.front();
  }
  if (fits.size() < 2)
    refuse(fmt::format(
        "{} puts {} of {} readings into standstills, {} {}, and too few postures are there to tell by "
        "distances: state it (offset_s)",
        shownOffset(offsets[0]), offsets[0].inside, readings.size(), shownOffset(offsets[1]), offsets[1].inside));
  if (!isDecided(fits)) {
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

/// The offsets that a user may state: the one that distances tell, else all that serve.
std::string shownServing(const std::vector<ClockOffset>& offsets, const std::vector<OffsetMisfit>& fits) {
  const auto shown = [](const ClockOffset& offset) {
    return fmt::format("{} of {}", shownOffset(offset), offset.inside);
  };
  if (offsets.size() == 1) return shown(offsets.front());
  if (fits.size() > 1 && isDecided(fits))
    return fmt::format("{}, by which distances between the reflectors' places are off by {:.1f} mm",
                       shown(offsets[fits.front().second]), 1e3 * fits.front().first);
  constexpr std::size_t kNamed = 5;
  std::vector<std::string> named;
  for (std::size_t i = 0; i < std::min(kNamed, offsets.size()); ++i) named.push_back(shown(offsets[i]));
  return fmt::format("{}{}, which distances between the reflectors' places do not tell apart",
                     fmt::join(named, ", or "),
                     offsets.size() > kNamed ? fmt::format(", or {} more", offsets.size() - kNamed) : std::string());
}

/// An offset that was stated must put nearly as many readings into standstills as the best does.
void requireStatedServes(const JoinTask& task, const std::vector<DayReading>& readings,
                         const std::vector<ReadingTime>& times, const std::vector<Standstill>& standstills,
                         const std::vector<ClockOffset>& offsets) {
  constexpr double kNearly = 0.9;
  const std::size_t inside = insideBy(times, standstills, *task.day.clock.offset_s);
  if (offsets.empty() || static_cast<double>(inside) >= kNearly * static_cast<double>(offsets.front().inside)) return;
  throw io::InputError(
      {task.day.file, task.source.line, "offset_s"}, fmt::format("{:g}", *task.day.clock.offset_s),
      fmt::format("expected an offset that puts the readings into standstills of the joints; this one does of {} of "
                  "{}, {}",
                  inside, times.size(), shownServing(offsets, misfitsBy(task, readings, standstills, offsets))));
}

/// Where stays are alike another offset serves as well and gives each posture the joints of the one beside. Distances
/// contradict it, and agree by the right one.
void requireStatedAgrees(const JoinTask& task, const std::vector<DayReading>& readings,
                         const std::vector<Standstill>& standstills, const std::vector<ClockOffset>& offsets,
                         const ClockReport& report) {
  if (!report.misfit || *report.misfit < kAsArmsDiffer) return;
  const std::vector<OffsetMisfit> fits = misfitsBy(task, readings, standstills, offsets);
  if (fits.empty() || kExplains * fits.front().first > *report.misfit) return;
  const ClockOffset& other = offsets[fits.front().second];
  if (fits.front().first >= kAsArmsDiffer) {
    // Neither agrees: the figures may mean something else.
    const ClockJoin join = joinedAt(task, readings, standstills, report.offset_s);
    requireMeaning(task, placedReadings(join.states, readings), *report.misfit);
  }
  throw io::InputError(
      {task.day.file, task.source.line, "offset_s"}, fmt::format("{:g}", report.offset_s),
      fmt::format("expected the offset by which readings find the joints of their postures; distances between the "
                  "reflectors' places are off by {:.1f} mm, with {} by {:.1f} mm",
                  1e3 * *report.misfit, shownOffset(other), 1e3 * fits.front().first));
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
    requireStatedServes(task, readings, times, standstills, offsets);
    report.stated = true;
    report.offset_s = *task.day.clock.offset_s;
    report.misfit = misfitAt(task, readings, standstills, report.offset_s);
    requireStatedAgrees(task, readings, standstills, offsets, report);
  } else {
    const ClockOffset chosen = chosenOffset(task, readings, standstills, offsets, report.misfit);
    report.offset_s = chosen.offset_s;
    report.uncertainty_s = chosen.uncertainty_s;
  }
  report.inside = insideBy(times, standstills, report.offset_s);
  ClockJoin join = joinedAt(task, readings, standstills, report.offset_s);
  StateJoin joined{std::move(join.states), {}, {}, report};
  for (const Standstill& still : standstills) joined.stretches.emplace_back(still.first, still.last);
  narrowToReadings(task, readings, report, joined);
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
