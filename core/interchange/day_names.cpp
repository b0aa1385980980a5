#include "core/interchange/day_names.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "core/io/input_error.h"
#include "core/io/numbers.h"

namespace stiffscope::interchange {

namespace {

bool isAmong(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string DayNames::mapped(const std::string& name) const {
  const auto found = day_.target_names.find(name);
  return found == day_.target_names.end() ? name : found->second;
}

int DayNames::targetNamed(const std::string& name) const {
  const auto& targets = day_.xml.campaign.targets;
  const auto found =
      std::find_if(targets.begin(), targets.end(), [&](const campaign::Target& one) { return one.id == name; });
  return found == targets.end() ? -1 : static_cast<int>(found - targets.begin());
}

std::optional<DayNames::Fields> DayNames::fieldsOf(const PointsSource& source, const PointReading& point) {
  if (!source.target.empty() && point.name.empty()) return Fields();
  return source.names.fieldsIn(point);
}

std::optional<DayReading> DayNames::readingOf(std::size_t source_index, const PointReading& point) const {
  const PointsSource& source = day_.points[source_index];
  const auto fields = fieldsOf(source, point);
  if (!fields) return std::nullopt;
  const auto field = [&](const char* name) {
    if (const auto found = fields->find(name); found != fields->end()) return found->second;
    return point.column(name);
  };
  const std::string name = source.target.empty() ? mapped(field("target")) : source.target;
  if (!source.only.empty() && !isAmong(source.only, name)) return std::nullopt;
  DayReading reading;
  reading.source = static_cast<std::uint32_t>(source_index);
  reading.line = static_cast<std::uint32_t>(point.line);
  reading.point = point.point;
  if (point.time) {
    reading.time_s = point.time->seconds;
    reading.resolution_s = point.time->resolution;
  }
  reading.target = targetNamed(name);
  if (reading.target < 0) return std::nullopt;
  // Of a sweep the index tells rows apart. Beside a pose it counts the rows of a table, of which one pose has several.
  const auto [own, other] = source.role == Role::loading ? std::pair("pose", "index") : std::pair("index", "pose");
  reading.pose = !source.pose.empty() ? source.pose : !field(own).empty() ? field(own) : field(other);
  if (reading.pose.empty() && source.by != JoinBy::clock) reading.pose = std::to_string(point.occurrence);
  const std::string step = source.step.empty() ? field("step") : source.step;
  reading.step = source.role == Role::loading ? wholeStep(day_.pathOf(source.file), point.line, step) : 0;
  reading.repeat = field("repeat");
  if (source.role != Role::circle_sweeps) return reading;
  reading.axis = source.axis;
  if (source.axis >= 0) return reading;
  const std::optional<int> axis = io::parseInteger(field("axis"));
  if (!axis || *axis < 1 || *axis > joints_)
    throw io::InputError({day_.pathOf(source.file), point.line, "axis"}, field("axis"),
                         fmt::format("expected an axis, 1 to {}, by the attribute axis, {{axis}} in names, or a column "
                                     "axis",
                                     joints_));
  reading.axis = *axis - 1;
  return reading;
}

std::string DayNames::nestOf(const PointsSource& source, const PointReading& point) const {
  const auto fields = fieldsOf(source, point);
  if (!fields) return {};
  const std::string name = !source.target.empty()       ? source.target
                           : fields->contains("nest")   ? mapped(fields->at("nest"))
                           : fields->contains("target") ? mapped(fields->at("target"))
                                                        : mapped(point.name);
  const bool kept = source.only.empty() ? targetNamed(name) < 0 : isAmong(source.only, name);
  return kept ? name : std::string();
}

std::vector<DayReading> DayNames::lostReadings(std::size_t source, const PointFile& points) const {
  std::vector<DayReading> lost;
  for (const PointReading& point : points.lost) {
    if (const auto reading = readingOf(source, point)) lost.push_back(*reading);
  }
  return lost;
}

void DayNames::refuseNames(std::size_t source, const PointFile& points, const char* of) const {
  throw io::InputError({day_.file, day_.points[source].line, "names"}, day_.points[source].file,
                       fmt::format("expected readings of {}; none of its {} names is of one, the first is '{}'", of,
                                   points.points.size(), points.points.empty() ? "" : points.points.front().name));
}

void DayNames::requireEqualOccurrences(std::size_t source_index, const PointFile& points,
                                       OccurrencesByStep& before) const {
  const PointsSource& source = day_.points[source_index];
  const bool posed =
      !source.pose.empty() || source.names.has("pose") || source.names.has("index") ||
      (!points.points.empty() && (points.points.front().hasColumn("pose") || points.points.front().hasColumn("index")));
  if (posed || source.by == JoinBy::clock || source.role == Role::nests) return;
  using Name = std::tuple<std::string, std::string, std::string>;
  std::map<Name, const PointReading*> last;
  std::map<std::pair<int, int>, const PointReading*> last_of_step;
  const auto count = [&](const PointReading& point) {
    const auto reading = readingOf(source_index, point);
    if (!reading) return;
    const PointReading*& most_of_step = last_of_step[{reading->axis, reading->step}];
    if (most_of_step == nullptr || point.occurrence > most_of_step->occurrence) most_of_step = &point;
    const PointReading*& most = last[Name{point.collection(), point.group(), point.name}];
    if (most == nullptr || point.occurrence > most->occurrence) most = &point;
  };
  for (const PointReading& point : points.points) count(point);
  for (const PointReading& point : points.lost) count(point);
  const auto [least, most] = std::minmax_element(last.begin(), last.end(), [](const auto& a, const auto& b) {
    return a.second->occurrence < b.second->occurrence;
  });
  const std::string file = day_.pathOf(source.file);
  constexpr const char* kOtherWays = ": say the pose in the names, or join by the clock";
  if (!last.empty() && least->second->occurrence != most->second->occurrence)
    throw io::InputError(
        {file, least->second->line, "name"}, least->second->name,
        fmt::format("expected names that repeat once a pose; this one stands {} times, {} {} times{}",
                    least->second->occurrence, most->second->name, most->second->occurrence, kOtherWays));
  for (const auto& [axis_and_step, point] : last_of_step) {
    const auto [other, first] = before.emplace(axis_and_step, Occurrences{point->occurrence, file});
    if (first || other->second.count == point->occurrence) continue;
    throw io::InputError({file, point->line, "name"}, point->name,
                         fmt::format("expected names that repeat once a pose; this one stands {} times, those of {} {} "
                                     "times (a lost beam is a row of 0 0 0){}",
                                     point->occurrence, other->second.file, other->second.count, kOtherWays));
  }
}

}  // namespace stiffscope::interchange
