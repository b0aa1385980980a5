#include "core/interchange/day_files.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "core/interchange/column_table.h"
#include "core/interchange/point_file.h"
#include "core/interchange/robot_log.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"
#include "core/io/read_file.h"
#include "core/robot/read_urdf.h"

namespace stiffscope::interchange {

namespace {

class DayReader {
 public:
  DayReader(const DayDescription& day, std::vector<std::string>& warnings) : day_(day), warnings_(warnings) {}

  DayFiles read() {
    readRobot();
    for (const PointsSource& source : day_.points) readPoints(source);
    for (const LogSource& source : day_.logs) readLog(source);
    for (const LoadsSource& source : day_.loads) readLoads(source);
    setEpoch();
    return std::move(result_);
  }

 private:
  /// Bytes of a file that DAY.xml names; its name goes into the list of files.
  io::TextFile bytesOf(const std::string& name, std::size_t line, const std::string& role) {
    std::error_code error;
    if (!std::filesystem::exists(day_.folder / name, error))
      throw io::InputError({day_.file, line, "file"}, name,
                           "expected a file beside DAY.xml; there is none of this name");
    io::TextFile bytes = io::readBytesWithStamp(day_.folder / name);
    result_.files.push_back({name, role, "", "", io::sha256Hex(bytes.text())});
    return bytes;
  }

  void keep(const std::vector<std::string>& warnings) {
    // A file that is read for two tables is warned of once.
    for (const std::string& warning : warnings) {
      if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) warnings_.push_back(warning);
    }
  }

  void readRobot() {
    const campaign::FileReference& urdf = day_.xml.urdf;
    const io::TextFile bytes = bytesOf(urdf.name, urdf.line, "urdf");
    const campaign::Campaign& campaign = day_.xml.campaign;
    result_.urdf = day_.folder / urdf.name;
    result_.robot = robot::parseUrdf(bytes.text(), day_.pathOf(urdf.name), campaign.base_link, campaign.flange_link);
    campaign::requireJoints(day_.xml.joint_numbers, result_.robot.joints());
    campaign::placeBalancers(day_.xml.balancers, result_.robot);
    for (const PointsSource& source : day_.points) {
      if (source.axis < result_.robot.joints()) continue;
      throw io::InputError({day_.file, source.line, "axis"}, std::to_string(source.axis + 1),
                           fmt::format("expected an axis, 1 to {}", result_.robot.joints()));
    }
  }

  void readPoints(const PointsSource& source) {
    const io::TextFile bytes = bytesOf(source.file, source.line, nameOf(source.role));
    PointFile points = parsePointFile(day_.pathOf(source.file), bytes.text(), source.options);
    result_.files.back().format = nameOf(points.format);
    result_.files.back().encoding = nameOf(points.encoding);
    keep(points.warnings);
    requireFrame(source, points);
    result_.points.push_back({std::move(points), result_.files.size() - 1});
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

  void readLog(const LogSource& source) {
    const io::TextFile bytes = bytesOf(source.file, source.line, "log");
    LogOptions options = source.options;
    options.joints = result_.robot.joints();
    RobotLog log = parseRobotLog(day_.pathOf(source.file), bytes.text(), options);
    result_.files.back().format = nameOf(log.format);
    result_.files.back().encoding = nameOf(log.encoding);
    keep(log.warnings);
    result_.logs.push_back({std::move(log), result_.files.size() - 1});
  }

  void readLoads(const LoadsSource& source) {
    const io::TextFile bytes = bytesOf(source.file, source.line, "loads");
    const std::string name = day_.pathOf(source.file);
    const DecodedText decoded = decodeText(name, bytes.text(), source.options.encoding);
    result_.files.back().format = nameOf(PointFormat::columns);
    result_.files.back().encoding = nameOf(decoded.encoding);
    const FileText text{name, decoded.text(), source.options};
    requireLines(name, text.text);
    if (!hasColumnHeader(text))
      throw io::InputError({name, 1, "columns"}, "",
                           "expected the names of its columns (columns), or a header line that has them");
    const ColumnTable table(text);
    keep(table.warnings());
    if (!table.has("pose") || !table.hasNumbers({"fx", "fy", "fz", "mx", "my", "mz"}))
      throw io::InputError({name, 0, "columns"}, source.options.columns,
                           "expected pose, perhaps step, and fx_n fy_n fz_n mx_nm my_nm mz_nm");
    table.forEachRow([&](const ColumnTable::Row& row) {
      const StatedLoad load{table.wrench(row), result_.files.size() - 1, row.line};
      const std::string pose = table.text(row, "pose");
      const auto [first, added] =
          result_.loads.emplace(std::pair(pose, wholeStep(name, row.line, table.text(row, "step"))), load);
      if (!added)
        throw io::InputError(
            {name, row.line, "pose"}, pose,
            fmt::format("expected one row of a pose and step; line {} has it first", first->second.line));
    });
  }

  /// Times of a calendar count from the first second of the day, others as they are.
  void setEpoch() {
    std::optional<Timestamp> first;
    std::set<bool> kinds;
    for (const DayFiles::Points& file : result_.points) {
      for (const PointReading& point : file.content.points) {
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
    for (DayFiles::Points& file : result_.points) {
      for (PointReading& point : file.content.points) {
        if (point.time) point.time = Timestamp{point.time->seconds - epoch, false, point.time->resolution};
      }
    }
  }

  const DayDescription& day_;
  std::vector<std::string>& warnings_;
  DayFiles result_;
  std::string frame_, frame_file_;
};

}  // namespace

int wholeStep(const std::string& file, std::size_t line, const std::string& step) {
  if (step.empty()) return 0;
  const std::optional<int> number = io::parseInteger(step);
  if (!number || *number < 0) throw io::InputError({file, line, "step"}, step, "expected a whole number, 0 or more");
  return *number;
}

DayFiles readDayFiles(const DayDescription& day, std::vector<std::string>& warnings) {
  return DayReader(day, warnings).read();
}

}  // namespace stiffscope::interchange
