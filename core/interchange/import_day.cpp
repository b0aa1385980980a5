#include "core/interchange/import_day.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <set>

#include "core/campaign/check_campaign.h"
#include "core/campaign/joint_reading.h"
#include "core/campaign/repeated_keys.h"
#include "core/campaign/table_layouts.h"
#include "core/interchange/day_names.h"
#include "core/interchange/nest_times.h"
#include "core/interchange/state_samples.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/units.h"

namespace stiffscope::interchange {

namespace {

/// Everything of a day while it becomes a campaign.
class DayImport {
 public:
  explicit DayImport(const std::filesystem::path& day_xml)
      : day_(described(day_xml)), files_(readDayFiles(day_, result_.warnings)), names_(day_, files_.robot.joints()) {
    std::string sha256 = std::move(result_.files.front().sha256);
    result_.campaign = day_.xml.campaign;
    result_.campaign.robot = files_.robot;
    if (const auto& rail = files_.robot.rail) {
      throw io::InputError({files_.urdf.string(), 0, rail->joint_name}, "prismatic",
                           "expected an arm that stands still: no file of a day is read for where its carriage stood. "
                           "Where it did not move the joint may be 'fixed' in the URDF");
    }
    result_.urdf = files_.urdf;
    result_.start = files_.start;
    files_.files.push_back({day_xml.filename().string(), "day", "", nameOf(Encoding::utf8), std::move(sha256)});
    result_.files = files_.files;
    used_samples_.resize(files_.logs.size());
    stretches_.resize(files_.logs.size());
  }

  ImportedDay made() {
    // Before the joins, which empty the files' contents.
    const auto stated = statedUncertainty(files_.points, result_.campaign.tracker);
    for (const Role role : {Role::circle_sweeps, Role::wrist_sweep, Role::loading}) importRole(role);
    requireNew(Role::circle_sweeps, campaign::circleSweepsLayout(files_.robot.joints()),
               result_.campaign.circle_sweeps);
    requireNew(Role::wrist_sweep, campaign::wristSweepLayout(files_.robot.joints()), result_.campaign.wrist_sweep);
    requireNew(Role::loading, campaign::loadingLayout(), result_.campaign.loading);
    importNests();
    importLogsAlone();
    for (std::size_t log = 0; log < files_.logs.size(); ++log) skipUnread(log);
    for (const auto& [key, load] : files_.loads) {
      if (!used_loads_.contains(key)) skipped_.emplace_back(load.file, SkippedRow{load.line, Skip::no_readings});
    }
    for (const auto& [file, row] : skipped_) {
      // A file read for two tables has each row in one of them, or is left out once.
      if (use(file, row.line)) result_.skipped.push_back({file, row});
    }
    if (stated) {
      result_.stated_sigma = stated->sigma;
      result_.stated_over_declared = stated->over_declared;
      if (const auto warning = warningOf(*stated, day_.file)) result_.warnings.push_back(*warning);
    }
    campaign::checkCampaign(result_.campaign, result_.warnings);
    if (const auto warning = leaveWrenchesOut(result_.campaign, without_wrench_, day_.file))
      result_.warnings.push_back(*warning);
    return std::move(result_);
  }

 private:
  DayDescription described(const std::filesystem::path& day_xml) {
    const io::TextFile bytes = io::readTextFileWithStamp(day_xml, io::kLargestXml);
    result_.files.push_back({day_xml.filename().string(), "day", "", "", io::sha256Hex(bytes.text())});
    return parseDayDescription(day_xml.string(), bytes.text(), result_.warnings);
  }

  /// Marks a line of a file as used, or not. Returns whether it was not before.
  bool use(std::size_t file, std::size_t line, bool used = true) {
    std::vector<bool>& lines = used_[result_.files[file].name];
    if (line >= lines.size()) lines.resize(std::max(line + 1, lines.size() * 2));
    const bool before = lines[line];
    lines[line] = used;
    return !before;
  }

  std::vector<DayReading> readingsOf(Role role, JoinBy by, std::size_t log, std::vector<DayReading>& lost) {
    std::vector<DayReading> readings;
    DayNames::OccurrencesByStep occurrences;
    for (std::size_t s = 0; s < day_.points.size(); ++s) {
      const PointsSource& source = day_.points[s];
      if (source.role != role || source.by != by || logOf(source) != log) continue;
      const std::size_t before = readings.size();
      readings.reserve(before + files_.points[s].content.points.size());
      names_.requireEqualOccurrences(s, files_.points[s].content, occurrences);
      for (const PointReading& point : files_.points[s].content.points) {
        if (const auto reading = names_.readingOf(s, point)) {
          readings.push_back(*reading);
          use(files_.points[s].file, point.line);
        } else {
          skipped_.emplace_back(files_.points[s].file, SkippedRow{point.line, Skip::another_point});
        }
      }
      for (const SkippedRow& row : files_.points[s].content.skipped) skipped_.emplace_back(files_.points[s].file, row);
      if (readings.size() == before) names_.refuseNames(s, files_.points[s].content, "the targets");
      if (by == JoinBy::order) {
        const std::vector<DayReading> own = names_.lostReadings(s, files_.points[s].content);
        lost.insert(lost.end(), own.begin(), own.end());
      }
      // Each file of points is read for one role: what it said is in the readings now.
      files_.points[s].content = {};
    }
    return readings;
  }

  /// Of a day without any log.
  static constexpr std::size_t kNoLog = static_cast<std::size_t>(-1);

  /// The log of a file's readings: its role's own, else the one for all. A day without logs has loaded and unloaded
  /// postures all the same; what its joints were is not known.
  std::size_t logOf(const PointsSource& source) const {
    if (day_.logs.empty() && source.role == Role::loading && source.by != JoinBy::clock) return kNoLog;
    std::size_t common = day_.logs.size();
    for (std::size_t i = 0; i < day_.logs.size(); ++i) {
      if (day_.logs[i].role == source.role) return i;
      if (!day_.logs[i].role && common == day_.logs.size()) common = i;
    }
    if (common == day_.logs.size())
      throw io::InputError({day_.file, source.line, "log"}, nameOf(source.role),
                           "expected an element log that gives the joints of this role");
    return common;
  }

  JoinTask taskOf(std::size_t log, Role role) const {
    return {day_, result_.campaign.robot, day_.logs[log], files_.logs[log].content, day_.pathOf(day_.logs[log].file),
            role};
  }

  /// What a join says beside its states.
  void keepSaid(std::size_t log, const StateJoin& join) {
    for (const std::size_t sample : join.merged)
      skipped_.emplace_back(files_.logs[log].file,
                            SkippedRow{files_.logs[log].content.samples[sample].line, Skip::repeated_row});
    result_.warnings.insert(result_.warnings.end(), join.warnings.begin(), join.warnings.end());
  }

  void importRole(Role role) {
    std::set<std::pair<JoinBy, std::size_t>> joins;
    for (const PointsSource& source : day_.points) {
      if (source.role == role) joins.emplace(source.by, logOf(source));
    }
    for (const auto& [by, log] : joins) {
      std::vector<DayReading> lost;
      const std::vector<DayReading> readings = readingsOf(role, by, log, lost);
      if (log == kNoLog) {
        addRows(role, log, joinNothing(readings), readings);
        continue;
      }
      JoinTask task = taskOf(log, role);
      task.lost = std::move(lost);
      const StateJoin join = by == JoinBy::name    ? joinByName(task, readings)
                             : by == JoinBy::order ? joinByOrder(task, readings)
                                                   : joinByClock(task, readings);
      if (join.clock) result_.clocks.push_back(*join.clock);
      keepSaid(log, join);
      stretches_[log].insert(join.stretches.begin(), join.stretches.end());
      for (const JoinedState& state : join.states) used_samples_[log].insert(state.first);
      for (const auto& [i, reason] : join.left_out) {
        const std::size_t file = files_.points[readings[i].source].file;
        skipped_.emplace_back(file, SkippedRow{readings[i].line, reason});
        use(file, readings[i].line, false);
      }
      judge(task, role, join, readings);
      addRows(role, log, join, readings);
    }
  }

  /// Without points of postures the logs are the day: what a controller states of its joints and its tool.
  void importLogsAlone() {
    const bool points = std::any_of(day_.points.begin(), day_.points.end(),
                                    [](const PointsSource& source) { return source.role != Role::nests; });
    if (points) return;
    for (std::size_t log = 0; log < day_.logs.size(); ++log) {
      StateJoin join = posturesOf(taskOf(log, Role::loading));
      // Of several logs each has its own numbers.
      for (JoinedState& state : join.states) {
        if (day_.logs.size() > 1) state.pose = fmt::format("{}.{}", log + 1, state.pose);
      }
      // Each stretch is a posture: none is left unread.
      keepSaid(log, join);
      addRows(Role::loading, log, join, {});
    }
  }

  void judge(const JoinTask& task, Role role, const StateJoin& join, const std::vector<DayReading>& readings) {
    const std::vector<PlacedReading> placed = placedReadings(join.states, readings);
    const auto misfit = chordMisfit(task.robot, day_.xml.campaign.joint_readings, placed);
    if (!misfit) return;
    requireMeaning(task, placed, *misfit);
    result_.misfit[nameOf(role)] = std::max(result_.misfit[nameOf(role)], *misfit);
    // As far as an arm can be from its nominal geometry.
    constexpr double kFar = 0.05;
    if (*misfit > kFar)
      result_.warnings.push_back(io::inputMessage(
          {day_.file, task.source.line, "log"}, task.source.file,
          fmt::format("distances between the reflectors' places are off by {:.1f} mm from the nominal arm's, and no "
                      "other sign, offset, coupling or unit explains it: do readings and joints belong together, is it "
                      "this robot?",
                      *misfit * 1e3)));
  }

  template <class Row>
  campaign::Table<Row>& tableOf(std::optional<campaign::Table<Row>>& table, Role role, const PointsSource& source) {
    if (!table) {
      table.emplace();
      table->file = std::string(nameOf(role)) + ".csv";
      table->frame = source.frame;
    }
    if (table->frame != source.frame)
      throw io::InputError({day_.file, source.line, "frame"}, source.file,
                           "expected one frame for all files of a role");
    return *table;
  }

  void addOrigin(Role role, const DayReading& reading) {
    result_.rows[nameOf(role)].push_back({files_.points[reading.source].file, reading.line, reading.line});
  }

  void addRows(Role role, std::size_t log, const StateJoin& join, const std::vector<DayReading>& readings) {
    const campaign::JointConvention convention(day_.xml.campaign.joint_readings, files_.robot.joints());
    reserve(role, readings);
    if (role == Role::loading && log != kNoLog && !join.states.empty()) reserveStates(join.states.size());
    for (const JoinedState& state : join.states) {
      const JointVector q = log == kNoLog ? JointVector() : convention.angles(state.figures);
      if (role == Role::loading && log != kNoLog) addState(state, log, q, convention, readings);
      std::map<int, int> counts;
      for (const std::size_t i : state.readings) {
        const DayReading& reading = readings[i];
        const int count = ++counts[reading.target];
        if (role == Role::loading) {
          addLoading(state, reading, count);
        } else {
          addSwept(role, state, reading, q, count);
        }
      }
    }
  }

  /// Room for the rows of a million readings, which doubling would take three times.
  void reserve(Role role, const std::vector<DayReading>& readings) {
    if (readings.empty()) return;
    std::vector<RowOrigin>& origins = result_.rows[nameOf(role)];
    origins.reserve(origins.size() + readings.size());
    if (role != Role::loading) return;
    auto& table = tableOf(result_.campaign.loading, role, day_.points[readings.front().source]);
    table.rows.reserve(table.rows.size() + readings.size());
  }

  void reserveStates(std::size_t more) {
    auto& table = result_.campaign.states;
    if (!table) table.emplace().file = "states.csv";
    std::vector<RowOrigin>& origins = result_.rows["states"];
    table->rows.reserve(table->rows.size() + more);
    origins.reserve(origins.size() + more);
    result_.campaign.pose_ids.reserve(result_.campaign.pose_ids.size() + more);
  }

  int poseNumber(const std::string& pose) {
    std::vector<std::string>& ids = result_.campaign.pose_ids;
    const auto [place, added] = poses_.emplace(pose, static_cast<int>(ids.size()));
    if (added) ids.push_back(pose);
    return place->second;
  }

  void addState(const JoinedState& state, std::size_t log, const JointVector& q,
                const campaign::JointConvention& convention, const std::vector<DayReading>& readings) {
    const RobotLog& content = files_.logs[log].content;
    const JointSample& sample = content.samples[state.first];
    auto& table = result_.campaign.states;
    campaign::State row(files_.robot.joints());
    row.pose = poseNumber(state.pose);
    row.step = state.step;
    row.q = q;
    // Times of a log alone are the robot's.
    row.time_s =
        state.readings.empty() ? sample.time_s.value_or(campaign::kNoTime) : readings[state.readings.front()].time_s;
    const StateMeans means = meansOf(content, state.first, state.last);
    if (!std::isnan(means.temperature_c)) row.extras().temperature_c = means.temperature_c;
    if (means.tool_pose.hasPosition() || means.tool_pose.hasTurn()) row.extras().tool_pose = means.tool_pose;
    const auto givenAngles = [&](const JointVector& figures) {
      return figures.size() > 0 && !figures.array().isNaN().all();
    };
    if (givenAngles(means.motor_side))
      row.extras().motor_side = convention.anglesBeside(means.motor_side, state.figures);
    if (givenAngles(means.commanded)) row.extras().commanded = convention.anglesBeside(means.commanded, state.figures);
    row.line = table->rows.size() + 2;
    const bool in_log = means.wrench.allFinite();
    if (in_log) row.wrench_in_cell = means.wrench;
    if (!in_log && files_.loads.empty()) ++without_wrench_;
    if (!files_.loads.empty()) {
      const auto load = files_.loads.find({state.pose, state.step});
      if (load == files_.loads.end())
        throw io::InputError({day_.pathOf(day_.loads.front().file), 0, "pose"},
                             fmt::format("{}, {}", state.pose, state.step),
                             "expected a load of every pose and step that was read");
      row.wrench_in_cell = load->second.wrench;
      used_loads_.insert(load->first);
      result_.wrenches.push_back({load->second.file, load->second.line, load->second.line});
    }
    table->rows.push_back(row);
    result_.rows["states"].push_back({files_.logs[log].file, sample.line, content.samples[state.last].line});
  }

  void addLoading(const JoinedState& state, const DayReading& reading, int count) {
    auto& table = tableOf(result_.campaign.loading, Role::loading, day_.points[reading.source]);
    campaign::LoadingReading row;
    row.pose = poseNumber(state.pose);
    row.step = state.step;
    row.repeat = reading.repeat.empty() ? count : campaign::repeatOf(reading.repeat, repeats_);
    if (repeats_.names().size() > result_.campaign.repeat_ids.size()) result_.campaign.repeat_ids = repeats_.names();
    row.target = reading.target;
    row.time_s = reading.time_s;
    row.point = reading.point;
    row.line = table.rows.size() + 2;
    table.rows.push_back(std::move(row));
    addOrigin(Role::loading, reading);
  }

  void addSwept(Role role, const JoinedState& state, const DayReading& reading, const JointVector& q, int count) {
    // A second reading of a reflector at one stop has a row of its own.
    const std::string index = count == 1 ? state.pose : fmt::format("{}.{}", state.pose, count);
    const PointsSource& source = day_.points[reading.source];
    const auto fill = [&](auto& table) {
      auto& row = table.rows.emplace_back();
      row.index = index;
      row.target = reading.target;
      row.q = q;
      row.point = reading.point;
      row.time_s = reading.time_s;
      row.line = table.rows.size() + 1;
    };
    if (role == Role::circle_sweeps) {
      auto& table = tableOf(result_.campaign.circle_sweeps, role, source);
      fill(table);
      table.rows.back().axis = state.axis;
    } else {
      fill(tableOf(result_.campaign.wrist_sweep, role, source));
    }
    addOrigin(role, reading);
  }

  /// No two rows of a table may be of one pose, step, repeat and target. Throws InputError for the later of two.
  template <class Row>
  void requireNew(Role role, const campaign::TableLayout<Row>& layout,
                  std::optional<campaign::Table<Row>>& table) const {
    if (!table) return;
    const campaign::KeyColumns<Row> key(layout);
    campaign::RowRepeats<Row> repeats(key, table->rows);
    for (std::size_t i = 0; i < table->rows.size(); ++i) {
      const std::size_t first = repeats.of(i);
      if (first == campaign::RepeatCheck::kNew) continue;
      const std::vector<RowOrigin>& origins = result_.rows.at(nameOf(role));
      const std::string& name = result_.campaign.targets[static_cast<std::size_t>(table->rows[i].target)].id;
      throw io::InputError(
          {day_.pathOf(result_.files[origins[i].file].name), origins[i].line, "name"}, name,
          fmt::format("expected a reading that does not repeat; line {} is of the same pose, step, repeat and target",
                      origins[first].line));
    }
  }

  void importNests() {
    std::map<std::string, int> nests;
    std::vector<double> resolutions;
    for (std::size_t s = 0; s < day_.points.size(); ++s) {
      const PointsSource& source = day_.points[s];
      if (source.role != Role::nests) continue;
      auto& table = tableOf(result_.campaign.nests, Role::nests, source);
      const std::size_t before = table.rows.size();
      for (const SkippedRow& row : files_.points[s].content.skipped) skipped_.emplace_back(files_.points[s].file, row);
      for (const PointReading& point : files_.points[s].content.points) {
        const std::string name = names_.nestOf(source, point);
        if (name.empty()) {
          skipped_.emplace_back(files_.points[s].file, SkippedRow{point.line, Skip::another_point});
          continue;
        }
        if (!point.time)
          throw io::InputError({day_.pathOf(source.file), point.line, "time"}, "",
                               "expected a time of a reading of a nest");
        use(files_.points[s].file, point.line);
        const auto [nest, added] = nests.emplace(name, static_cast<int>(result_.campaign.nest_ids.size()));
        if (added) result_.campaign.nest_ids.push_back(name);
        resolutions.push_back(point.time->resolution);
        table.rows.push_back({point.time->seconds, nest->second, point.point, table.rows.size() + 2});
        result_.rows["nests"].push_back({files_.points[s].file, point.line, point.line});
      }
      if (table.rows.size() == before) names_.refuseNames(s, files_.points[s].content, "nests");
    }
    if (result_.campaign.nests) keepNestsApart(result_.campaign.nests->rows, resolutions);
  }

  void keepNestsApart(std::vector<campaign::NestReading>& rows, const std::vector<double>& resolutions) {
    const MovedNests moved = keepTimesApart(rows, resolutions);
    if (moved.count == 0) return;
    const RowOrigin& origin = result_.rows.at("nests")[moved.first];
    result_.warnings.push_back(io::inputMessage(
        {day_.pathOf(result_.files[origin.file].name), origin.line, "time"}, "",
        fmt::format("{} readings of nests, this one first, have the time of an earlier one of the same nest; they are "
                    "written by up to {:g} s later, to be told apart",
                    moved.count, moved.farthest_s)));
  }

  /// Standstills, rows and targets of a log in which nothing was read, and what it has without joint angles.
  void skipUnread(std::size_t log) {
    const DayFiles::Log& own = files_.logs[log];
    for (const SkippedRow& row : own.content.skipped) skipped_.emplace_back(own.file, row);
    const auto states = result_.rows.find("states");
    const bool given =
        states != result_.rows.end() && std::any_of(states->second.begin(), states->second.end(),
                                                    [&](const RowOrigin& row) { return row.file == own.file; });
    const auto warning = warningOfUntaken(own.content, day_.pathOf(day_.logs[log].file), given, !files_.loads.empty());
    if (warning) result_.warnings.push_back(*warning);
    for (const auto& [first, last] : stretches_[log]) {
      const auto used = used_samples_[log].lower_bound(first);
      if (used == used_samples_[log].end() || *used > last)
        skipped_.emplace_back(own.file, SkippedRow{own.content.samples[first].line, Skip::no_readings});
    }
  }

  ImportedDay result_;
  const DayDescription day_;
  DayFiles files_;
  const DayNames names_;
  std::map<std::string, int> poses_;
  campaign::NameList repeats_;
  std::vector<std::set<std::size_t>> used_samples_;                       ///< by log, the first of each state
  std::vector<std::set<std::pair<std::size_t, std::size_t>>> stretches_;  ///< by log, what could be joined
  std::set<std::pair<std::string, int>> used_loads_;
  std::size_t without_wrench_ = 0;  ///< states that neither a log nor a file of loads gives one
  std::vector<std::pair<std::size_t, SkippedRow>> skipped_;
  std::map<std::string, std::vector<bool>> used_;  ///< by the file's name, its lines
};

}  // namespace

ImportedDay importDay(const std::filesystem::path& day_xml) { return DayImport(day_xml).made(); }

}  // namespace stiffscope::interchange
