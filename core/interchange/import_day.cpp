#include "core/interchange/import_day.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <set>

#include "core/campaign/check_campaign.h"
#include "core/campaign/joint_reading.h"
#include "core/interchange/column_table.h"
#include "core/interchange/point_file.h"
#include "core/interchange/robot_log.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"
#include "core/io/read_file.h"
#include "core/robot/read_urdf.h"

namespace stiffscope::interchange {

namespace {

namespace fs = std::filesystem;

/// A wrench by pose and step, and its line.
struct StatedLoad {
  Vector6d wrench = Vector6d::Zero();
  std::size_t line = 0;
};
using Loads = std::map<std::pair<std::string, int>, StatedLoad>;

/// Everything of a day while it becomes a campaign.
class DayImport {
 public:
  explicit DayImport(const fs::path& day_xml) {
    const io::TextFile bytes = io::readTextFileWithStamp(day_xml, io::kLargestXml);
    day_ = parseDayDescription(day_xml.string(), bytes.text(), result_.warnings);
    result_.files.push_back({day_xml.filename().string(), "day", "", "utf-8", io::sha256Hex(bytes.text())});
    result_.campaign = day_.xml.campaign;
    readRobotFile();
    readFiles();
  }

  ImportedDay made() {
    setEpoch();
    for (const Role role : {Role::circle_sweeps, Role::wrist_sweep, Role::loading}) importRole(role);
    importNests();
    for (const auto& [file, row] : skipped_) {
      // A file read for two tables has each row in one of them, or is left out once.
      if (used_.insert(placeOf(file, row.line)).second) result_.skipped.push_back({file, row});
    }
    compareUncertainties();
    campaign::checkCampaign(result_.campaign, result_.warnings);
    return std::move(result_);
  }

 private:
  struct FilePoints {
    PointFile points;
    std::size_t file = 0;  ///< of the result's files
  };

  /// Bytes of a file that DAY.xml names; its name goes into the list of files.
  io::TextFile read(const std::string& name, std::size_t line, const std::string& role) {
    std::error_code error;
    if (!fs::exists(day_.folder / name, error))
      throw io::InputError({day_.file, line, "file"}, name,
                           "expected a file beside DAY.xml; there is none of this name");
    io::TextFile bytes = io::readBytesWithStamp(day_.folder / name);
    result_.files.push_back({name, role, "", "", io::sha256Hex(bytes.text())});
    return bytes;
  }

  std::string shown(const std::string& name) const { return (day_.folder / name).string(); }

  std::pair<std::string, std::size_t> placeOf(std::size_t file, std::size_t line) const {
    return {result_.files[file].name, line};
  }

  void readRobotFile() {
    const campaign::FileReference& urdf = day_.xml.urdf;
    const io::TextFile bytes = read(urdf.name, urdf.line, "urdf");
    result_.urdf = day_.folder / urdf.name;
    campaign::Campaign& campaign = result_.campaign;
    campaign.robot = robot::parseUrdf(bytes.text(), shown(urdf.name), campaign.base_link, campaign.flange_link);
  }

  void readFiles() {
    for (PointsSource& source : day_.points) {
      const io::TextFile bytes = read(source.file, source.line, nameOf(source.role));
      PointFile points = parsePointFile(shown(source.file), bytes.text(), source.options);
      result_.files.back().format = nameOf(points.format);
      result_.files.back().encoding = nameOf(points.encoding);
      keep(points.warnings);
      requireFrame(source, points);
      points_.push_back({std::move(points), result_.files.size() - 1});
    }
    for (const LogSource& source : day_.logs) {
      const io::TextFile bytes = read(source.file, source.line, "log");
      logs_.push_back(parseRobotLog(shown(source.file), bytes.text(), source.options));
      result_.files.back().format = nameOf(logs_.back().format);
      result_.files.back().encoding = nameOf(logs_.back().encoding);
      log_files_.push_back(result_.files.size() - 1);
      keep(logs_.back().warnings);
      for (const SkippedRow& row : logs_.back().skipped) skipped_.emplace_back(log_files_.back(), row);
    }
    for (const LoadsSource& source : day_.loads) readLoads(source);
  }

  void keep(const std::vector<std::string>& warnings) {
    // A file that is read for two tables is warned of once.
    for (const std::string& warning : warnings) {
      if (std::find(result_.warnings.begin(), result_.warnings.end(), warning) == result_.warnings.end())
        result_.warnings.push_back(warning);
    }
  }

  /// All points of a day stand in one frame.
  void requireFrame(const PointsSource& source, const PointFile& points) {
    if (source.frame != campaign::PointFrame::tracker || points.frame.empty()) return;
    if (frame_.empty()) {
      frame_ = points.frame;
      frame_file_ = source.file;
    }
    if (points.frame == frame_) return;
    throw io::InputError({day_.file, source.line, "file"}, source.file,
                         fmt::format("expected points in one frame; these are in {}, those of {} in {}", points.frame,
                                     frame_file_, frame_));
  }

  void readLoads(const LoadsSource& source) {
    const io::TextFile bytes = read(source.file, source.line, "loads");
    const std::string name = shown(source.file);
    const DecodedText decoded = decodeText(name, bytes.text(), source.options.encoding);
    result_.files.back().format = "columns";
    result_.files.back().encoding = nameOf(decoded.encoding);
    const FileText text{name, decoded.text, source.options};
    if (!hasColumnHeader(text))
      throw io::InputError({name, 1, "columns"}, "",
                           "expected the names of its columns (columns), or a header line that has them");
    const ColumnTable table(text);
    if (!table.has("pose") || !table.hasNumbers({"fx", "fy", "fz", "mx", "my", "mz"}))
      throw io::InputError({name, 0, "columns"}, source.options.columns,
                           "expected pose, perhaps step, and fx_n fy_n fz_n mx_nm my_nm mz_nm");
    for (const ColumnTable::Row& row : table.rows()) {
      StatedLoad load;
      load.line = row.line;
      load.wrench << table.number(row, "fx"), table.number(row, "fy"), table.number(row, "fz"), table.number(row, "mx"),
          table.number(row, "my"), table.number(row, "mz");
      const auto [first, added] =
          loads_.emplace(std::pair(table.text(row, "pose"), wholeStep(name, row.line, table.text(row, "step"))), load);
      if (!added)
        throw io::InputError(
            {name, row.line, "pose"}, table.text(row, "pose"),
            fmt::format("expected one row of a pose and step; line {} has it first", first->second.line));
    }
  }

  static int wholeStep(const std::string& file, std::size_t line, const std::string& step) {
    if (step.empty()) return 0;
    const std::optional<int> number = io::parseInteger(step);
    if (!number || *number < 0) throw io::InputError({file, line, "step"}, step, "expected a whole number, 0 or more");
    return *number;
  }

  /// The name the campaign has for a point's target.
  std::string mapped(const std::string& name) const {
    const auto found = day_.target_names.find(name);
    return found == day_.target_names.end() ? name : found->second;
  }

  int targetNamed(const std::string& name) const {
    const auto& targets = result_.campaign.targets;
    const auto found =
        std::find_if(targets.begin(), targets.end(), [&](const campaign::Target& one) { return one.id == name; });
    return found == targets.end() ? -1 : static_cast<int>(found - targets.begin());
  }

  /// What a point's name and file say; nullopt where it is none of the role's.
  std::optional<DayReading> readingOf(std::size_t source_index, const PointReading& point) const {
    const PointsSource& source = day_.points[source_index];
    const auto fields = source.names.fieldsIn(point);
    if (!fields) return std::nullopt;
    const auto field = [&](const char* name) {
      const auto found = fields->find(name);
      return found == fields->end() ? std::string() : found->second;
    };
    const std::string name = source.target.empty() ? mapped(field("target")) : source.target;
    if (!source.only.empty() && std::find(source.only.begin(), source.only.end(), name) == source.only.end())
      return std::nullopt;
    DayReading reading;
    reading.source = source_index;
    reading.point = &point;
    reading.target = targetNamed(name);
    if (reading.target < 0) return std::nullopt;
    reading.pose = !source.pose.empty() ? source.pose : source.names.has("index") ? field("index") : field("pose");
    if (reading.pose.empty() && source.by != JoinBy::clock) reading.pose = std::to_string(point.occurrence);
    const std::string step = source.step.empty() ? field("step") : source.step;
    reading.step = source.role == Role::loading ? wholeStep(shown(source.file), point.line, step) : 0;
    reading.repeat = field("repeat");
    if (source.role != Role::circle_sweeps) return reading;
    reading.axis = source.axis;
    if (source.axis >= 0) return reading;
    const std::optional<int> axis = io::parseInteger(field("axis"));
    if (!axis || *axis < 1 || *axis > 6)
      throw io::InputError({shown(source.file), point.line, "axis"}, field("axis"), "expected an axis, 1 to 6");
    reading.axis = *axis - 1;
    return reading;
  }

  std::vector<DayReading> readingsOf(Role role, JoinBy by, std::size_t log) {
    std::vector<DayReading> readings;
    for (std::size_t s = 0; s < day_.points.size(); ++s) {
      const PointsSource& source = day_.points[s];
      if (source.role != role || source.by != by || logOf(source) != log) continue;
      const std::size_t before = readings.size();
      for (const PointReading& point : points_[s].points.points) {
        if (const auto reading = readingOf(s, point)) {
          readings.push_back(*reading);
          used_.insert(placeOf(points_[s].file, point.line));
        } else {
          skipped_.emplace_back(points_[s].file, SkippedRow{point.line, Skip::another_point});
        }
      }
      for (const SkippedRow& row : points_[s].points.skipped) skipped_.emplace_back(points_[s].file, row);
      if (readings.size() == before)
        throw io::InputError(
            {day_.file, source.line, "names"}, source.file,
            fmt::format("expected readings of the targets; none of its {} names is of one, the first is '{}'",
                        points_[s].points.points.size(),
                        points_[s].points.points.empty() ? "" : points_[s].points.points.front().name));
    }
    return readings;
  }

  /// The log of a file's readings: its role's own, else the one for all.
  std::size_t logOf(const PointsSource& source) const {
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

  void importRole(Role role) {
    std::set<std::pair<JoinBy, std::size_t>> joins;
    for (const PointsSource& source : day_.points) {
      if (source.role == role) joins.emplace(source.by, logOf(source));
    }
    for (const auto& [by, log] : joins) {
      const std::vector<DayReading> readings = readingsOf(role, by, log);
      const JoinTask task{day_, result_.campaign.robot, day_.logs[log], logs_[log], shown(day_.logs[log].file)};
      const StateJoin join = by == JoinBy::name    ? joinByName(task, readings)
                             : by == JoinBy::order ? joinByOrder(task, readings)
                                                   : joinByClock(task, readings);
      if (join.clock) result_.clocks.push_back(*join.clock);
      for (const auto& [i, reason] : join.left_out) {
        const std::size_t file = points_[readings[i].source].file;
        skipped_.emplace_back(file, SkippedRow{readings[i].point->line, reason});
        used_.erase(placeOf(file, readings[i].point->line));
      }
      judge(task, role, join, readings);
      addRows(role, log, join, readings);
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
                      "other sign, offset, "
                      "coupling or unit explains it: do readings and joints belong together, is it this robot?",
                      *misfit * 1e3)));
  }

  static double timeOf(const PointReading& point) { return point.time ? point.time->seconds : campaign::kNoTime; }

  /// Times of a calendar count from the first second of the day, others as they are.
  void setEpoch() {
    std::optional<Timestamp> first;
    std::set<bool> kinds;
    for (const FilePoints& file : points_) {
      for (const PointReading& point : file.points.points) {
        if (!point.time) continue;
        kinds.insert(point.time->dated);
        if (!first || point.time->seconds < first->seconds) first = point.time;
      }
    }
    if (kinds.size() > 1)
      throw io::InputError({day_.file, 0, "points"}, "",
                           "expected times of one kind in all files of points: dates, or seconds");
    if (!first || !first->dated) return;
    const double epoch = std::floor(first->seconds);
    result_.start = isoTime({epoch, true, 1.0});
    for (FilePoints& file : points_) {
      for (PointReading& point : file.points.points) {
        if (point.time) point.time = Timestamp{point.time->seconds - epoch, false, point.time->resolution};
      }
    }
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
    result_.rows[nameOf(role)].push_back({points_[reading.source].file, reading.point->line, reading.point->line});
  }

  void addRows(Role role, std::size_t log, const StateJoin& join, const std::vector<DayReading>& readings) {
    const campaign::JointConvention convention(day_.xml.campaign.joint_readings);
    for (const JoinedState& state : join.states) {
      const Vector6d q = convention.angles(state.figures);
      if (role == Role::loading) addState(state, log, q, readings);
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

  int poseNumber(const std::string& pose) {
    std::vector<std::string>& ids = result_.campaign.pose_ids;
    const auto [place, added] = poses_.emplace(pose, static_cast<int>(ids.size()));
    if (added) ids.push_back(pose);
    return place->second;
  }

  void addState(const JoinedState& state, std::size_t log, const Vector6d& q, const std::vector<DayReading>& readings) {
    const JointSample& sample = logs_[log].samples[state.first];
    auto& table = result_.campaign.states;
    if (!table) table.emplace().file = "states.csv";
    campaign::State row;
    row.pose = poseNumber(state.pose);
    row.step = state.step;
    row.q = q;
    row.time_s = timeOf(*readings[state.readings.front()].point);
    row.temperature_c = sample.temperature_c;
    row.line = table->rows.size() + 2;
    if (sample.wrench) row.wrench_in_cell = *sample.wrench;
    if (!loads_.empty()) {
      const auto load = loads_.find({state.pose, state.step});
      if (load == loads_.end())
        throw io::InputError({shown(day_.loads.front().file), 0, "pose"}, fmt::format("{}, {}", state.pose, state.step),
                             "expected a load of every pose and step that was read");
      row.wrench_in_cell = load->second.wrench;
    }
    table->rows.push_back(row);
    result_.rows["states"].push_back({log_files_[log], sample.line, logs_[log].samples[state.last].line});
  }

  void addLoading(const JoinedState& state, const DayReading& reading, int count) {
    auto& table = tableOf(result_.campaign.loading, Role::loading, day_.points[reading.source]);
    campaign::LoadingReading row;
    row.pose = poseNumber(state.pose);
    row.step = state.step;
    row.repeat = reading.repeat.empty() ? std::to_string(count) : reading.repeat;
    row.target = reading.target;
    row.time_s = timeOf(*reading.point);
    row.point = reading.point->point;
    row.line = table.rows.size() + 2;
    requireNew(reading, fmt::format("{}\n{}\n{}\n{}", state.pose, state.step, row.repeat, row.target));
    table.rows.push_back(std::move(row));
    addOrigin(Role::loading, reading);
  }

  void addSwept(Role role, const JoinedState& state, const DayReading& reading, const Vector6d& q, int count) {
    // A second reading of a reflector at one stop has a row of its own.
    const std::string index = count == 1 ? state.pose : fmt::format("{}.{}", state.pose, count);
    requireNew(reading, fmt::format("{}\n{}\n{}\n{}", nameOf(role), state.axis, index, reading.target));
    const PointsSource& source = day_.points[reading.source];
    const auto fill = [&](auto& table) {
      auto& row = table.rows.emplace_back();
      row.index = index;
      row.target = reading.target;
      row.q = q;
      row.point = reading.point->point;
      row.time_s = timeOf(*reading.point);
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

  void requireNew(const DayReading& reading, const std::string& key) {
    const auto [first, added] = keys_.emplace(key, reading.point->line);
    if (added) return;
    throw io::InputError(
        {shown(day_.points[reading.source].file), reading.point->line, "name"}, reading.point->name,
        fmt::format("expected a reading that does not repeat; line {} is of the same pose, step, repeat and target",
                    first->second));
  }

  void importNests() {
    std::map<std::string, int> nests;
    std::set<std::pair<double, int>> times;
    for (std::size_t s = 0; s < day_.points.size(); ++s) {
      const PointsSource& source = day_.points[s];
      if (source.role != Role::nests) continue;
      auto& table = tableOf(result_.campaign.nests, Role::nests, source);
      for (const PointReading& point : points_[s].points.points) {
        const auto fields = source.names.fieldsIn(point);
        const std::string name = !fields ? ""
                                         : mapped(fields->contains("nest")     ? fields->at("nest")
                                                  : fields->contains("target") ? fields->at("target")
                                                                               : point.name);
        const bool kept = !name.empty() && (source.only.empty() ? targetNamed(name) < 0
                                                                : std::find(source.only.begin(), source.only.end(),
                                                                            name) != source.only.end());
        if (!kept) {
          skipped_.emplace_back(points_[s].file, SkippedRow{point.line, Skip::another_point});
          continue;
        }
        if (!point.time)
          throw io::InputError({shown(source.file), point.line, "time"}, "", "expected a time of a reading of a nest");
        used_.insert(placeOf(points_[s].file, point.line));
        const auto [nest, added] = nests.emplace(name, static_cast<int>(result_.campaign.nest_ids.size()));
        if (added) result_.campaign.nest_ids.push_back(name);
        // Within the last digit of a clock one follows another.
        double time = timeOf(point);
        constexpr double kTick = 0.1;
        while (!times.emplace(std::round(time / kTick) * kTick, nest->second).second) time += kTick;
        table.rows.push_back({time, nest->second, point.point, table.rows.size() + 2});
        result_.rows["nests"].push_back({points_[s].file, point.line, point.line});
      }
    }
  }

  /// The files' standard uncertainties beside what the campaign declares of the tracker: median of their ratio.
  void compareUncertainties() {
    if (!result_.campaign.tracker) return;
    const campaign::Tracker& tracker = *result_.campaign.tracker;
    std::vector<double> ratios;
    for (const FilePoints& file : points_) {
      for (const PointReading& point : file.points.points) {
        if (!point.sigma) continue;
        const double distance = (point.point - tracker.station).norm();
        const double along = tracker.range_fixed + tracker.range_per_m * distance,
                     across = tracker.angle_fixed + tracker.angle_per_m * distance;
        ratios.push_back(point.sigma->norm() / std::sqrt(along * along + 2.0 * across * across));
      }
    }
    if (ratios.empty()) return;
    std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2), ratios.end());
    const double ratio = ratios[ratios.size() / 2];
    result_.stated_over_declared = ratio;
    // As the audit's check of declared noise.
    constexpr double kApart = 2.0;
    if (ratio <= kApart && ratio >= 1.0 / kApart) return;
    result_.warnings.push_back(io::inputMessage(
        {day_.file, 0, "tracker"}, "",
        fmt::format(
            "the uncertainties in the files are {:.2g} times the noise declared of the tracker (median of {} readings)",
            ratio, ratios.size())));
  }

  DayDescription day_;
  ImportedDay result_;
  std::vector<FilePoints> points_;
  std::vector<RobotLog> logs_;
  std::vector<std::size_t> log_files_;
  Loads loads_;
  std::string frame_, frame_file_;
  std::map<std::string, int> poses_;
  std::map<std::string, std::size_t> keys_;
  std::vector<std::pair<std::size_t, SkippedRow>> skipped_;
  std::set<std::pair<std::string, std::size_t>> used_;  ///< file and line
};

}  // namespace

ImportedDay importDay(const fs::path& day_xml) { return DayImport(day_xml).made(); }

}  // namespace stiffscope::interchange
