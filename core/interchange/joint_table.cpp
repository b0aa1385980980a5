#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/interchange/column_table.h"
#include "core/interchange/day_files.h"
#include "core/interchange/log_formats.h"
#include "core/io/csv.h"
#include "core/io/input_error.h"
#include "core/io/units.h"

namespace stiffscope::interchange {

namespace {

/// Where a table has the joints and perhaps the time.
struct JointHeader {
  std::size_t line = 0;  ///< 0: there is none
  char separator = ';';
  std::size_t cells = 0;
  PerJoint<std::size_t> joints;
  std::string beyond;  ///< the column of a joint that the machine has not; empty: there is none
  std::optional<std::array<std::size_t, 6>> pose;  ///< X Y Z W P R
  std::optional<std::size_t> time;
  double seconds_per_unit = 1.0;
  std::vector<std::string> unread;  ///< other columns, as they are written, but those behind `beyond`
};

std::vector<std::string_view> logCells(std::string_view line, char separator) {
  auto cells = separator == ' ' ? cellsBetweenBlanks(line, 1) : cellsBetween(line, separator);
  if (!cells.empty() && cells.back().empty()) cells.pop_back();
  return cells;
}

/// The names a format's header has for so many joints, and for one more.
struct JointNames {
  std::vector<std::string> names;
  std::string beyond;  ///< empty: there is no such name
};

JointNames numberedNames(const char* pattern, int joints, int first) {
  JointNames all;
  for (int j = 0; j < joints; ++j) all.names.push_back(fmt::format(fmt::runtime(pattern), j + first));
  all.beyond = fmt::format(fmt::runtime(pattern), joints + first);
  return all;
}

/// In several ways of writing.
std::vector<JointNames> jointNames(LogFormat format, int joints) {
  if (format == LogFormat::fanuc_karel) return {numberedNames("j{}", joints, 1)};
  std::vector<JointNames> all;
  if (joints == 6) {
    all = {{{"shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint",
             "wrist_3_joint"},
            {}},
           {{"base", "shoulder", "elbow", "wrist1", "wrist2", "wrist3"}, {}},
           {{"base", "shoulder", "elbow", "wrist 1", "wrist 2", "wrist 3"}, {}}};
  }
  for (const char* pattern : {"joint{}", "joint_{}", "actual_q_{}", "actual_q{}", "actual_q[{}]", "q{}", "q_{}",
                              "q[{}]", "joint_position_{}", "joint_positions_{}"}) {
    for (const int first : {0, 1}) all.push_back(numberedNames(pattern, joints, first));
  }
  return all;
}

/// Millisecond or second of a column of time; nullopt for another column. Without a unit UR's are seconds.
std::optional<double> timeUnit(const std::string& name, LogFormat format) {
  if (!name.starts_with("time")) return std::nullopt;
  if (name.find("ms") != std::string::npos && name.find("timestamp") != 0) return 1e-3;
  if (name == "timestamp [ms]" || name == "timestamp_ms") return 1e-3;
  if (name == "time" || name == "timestamp" || name.find("[s]") != std::string::npos || name.ends_with("_s"))
    return format == LogFormat::fanuc_karel && name == "time" ? std::nullopt : std::optional(1.0);
  return std::nullopt;
}

/// Where X Y Z and W P R stand, all of them: FANUC's pose of the tool in the user frame, mm and degrees. W, P and R
/// turn about fixed x, y and z, in this order.
std::optional<std::array<std::size_t, 6>> poseColumns(const std::vector<std::string>& cells) {
  std::array<std::size_t, 6> places{};
  constexpr std::array<const char*, 6> kNames{"x", "y", "z", "w", "p", "r"};
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    const auto found = std::find(cells.begin(), cells.end(), kNames[k]);
    if (found == cells.end()) return std::nullopt;
    places[k] = static_cast<std::size_t>(found - cells.begin());
  }
  return places;
}

/// Keeps the names of the columns before `end` that nothing is read of.
void noteUnread(JointHeader& header, const std::vector<std::string_view>& cells, std::size_t end) {
  for (std::size_t k = 0; k < std::min(end, cells.size()); ++k) {
    const bool joint = std::find(header.joints.begin(), header.joints.end(), k) != header.joints.end();
    const bool pose = header.pose && std::find(header.pose->begin(), header.pose->end(), k) != header.pose->end();
    if (!joint && !pose && header.time != k && !cells[k].empty()) header.unread.emplace_back(cells[k]);
  }
}

JointHeader jointHeaderOf(const LogText& text, LogFormat format, int joints) {
  for (const TextLine& line : linesOf(text.text)) {
    if (line.number <= text.options.table.skip || trimmed(line.text).empty()) continue;
    for (const char separator : {';', ',', '\t', ' '}) {
      if (format == LogFormat::fanuc_karel && separator != ';') continue;
      JointHeader header;
      header.line = line.number;
      header.separator = separator;
      std::vector<std::string> cells;
      for (const std::string_view cell : logCells(line.text, separator)) cells.push_back(lowered(cell));
      header.cells = cells.size();
      for (std::size_t k = 0; k < cells.size() && !header.time; ++k) {
        const auto unit = timeUnit(cells[k], format);
        if (!unit) continue;
        header.time = k;
        header.seconds_per_unit = *unit;
      }
      for (const auto& [names, beyond] : jointNames(format, joints)) {
        bool all = true;
        header.joints.clear();
        for (const std::string& name : names) {
          const auto found = std::find(cells.begin(), cells.end(), name);
          all = all && found != cells.end();
          header.joints.push_back(static_cast<std::size_t>(found - cells.begin()));
        }
        if (!all || (format == LogFormat::fanuc_karel && !header.time)) continue;
        if (format == LogFormat::fanuc_karel) header.pose = poseColumns(cells);
        const auto more = std::find(cells.begin(), cells.end(), beyond);
        if (more != cells.end()) header.beyond = beyond;
        noteUnread(header, logCells(line.text, separator), static_cast<std::size_t>(more - cells.begin()));
        return header;
      }
    }
    return {};
  }
  return {};
}

campaign::StatedPose poseOf(const LogText& text, const std::vector<std::string_view>& cells, std::size_t line,
                            const std::array<std::size_t, 6>& places, DecimalSign sign) {
  constexpr std::array<const char*, 6> kShown{"X", "Y", "Z", "W", "P", "R"};
  campaign::StatedPose pose;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double value = decimal(cells[places[k]], sign, text.file, line, kShown[k]);
    if (k < 3)
      pose.position[static_cast<Eigen::Index>(k)] = value * io::kMillimetre;
    else
      pose.rpy[static_cast<Eigen::Index>(k) - 3] = value * io::kDegree;
  }
  return pose;
}

/// The warning of a joint that the machine has not.
std::string leftOut(const LogText& text, std::size_t line, const std::string& column) {
  return io::inputMessage({text.file, line, ""}, "",
                          fmt::format("columns that are not read: {} and what is behind it; the machine has {} joints",
                                      column, countedJoints(text.options.joints)));
}

/// The warning of columns of another kind: currents and speeds, or an external axis, which may have carried the arm.
std::string notRead(const LogText& text, const JointHeader& header) {
  constexpr std::size_t kNamed = 8;
  const std::vector<std::string>& all = header.unread;
  const std::vector<std::string> named(all.begin(),
                                       all.begin() + static_cast<std::ptrdiff_t>(std::min(kNamed, all.size())));
  return io::inputMessage(
      {text.file, header.line, ""}, "",
      fmt::format("columns that are not read: {}{}", fmt::join(named, ", "),
                  all.size() > kNamed ? fmt::format(" and {} more", all.size() - kNamed) : std::string()));
}

/// Joints that a table has a column of such a kind for, from 0: m1, m2 and so on of `m`.
std::vector<int> jointsOf(const ColumnTable& table, const std::string& kind, int joints) {
  std::vector<int> found;
  for (int j = 0; j < joints; ++j) {
    if (table.hasNumber(kind + std::to_string(j + 1))) found.push_back(j);
  }
  return found;
}

/// The angles of these joints, not a number of the others and where a cell is blank. Throws InputError for one that no
/// table of states could hold.
JointVector anglesIn(const ColumnTable& table, const ColumnTable::Row& row, const std::string& kind,
                     const std::vector<int>& of, const LogText& text) {
  constexpr double kMost = 720.0 * io::kDegree;
  JointVector angles = JointVector::Constant(text.options.joints, campaign::kNotGiven);
  for (const int j : of) {
    const std::string quantity = kind + std::to_string(j + 1);
    angles[j] = table.numberOrBlank(row, quantity);
    if (std::abs(angles[j]) > kMost)
      throw io::InputError({text.file, row.line, quantity}, fmt::format("{:.6g} deg", angles[j] / io::kDegree),
                           "expected an angle within +-720 deg: of the motors' side it is the motor's over the gear "
                           "ratio");
  }
  return angles;
}

}  // namespace

std::string countedJoints(int joints) {
  constexpr std::array<const char*, kMostJoints - kFewestJoints + 1> kCounts{"four", "five", "six", "seven", "eight"};
  return kCounts.at(static_cast<std::size_t>(joints - kFewestJoints));
}

// A table of six joints is recognised whatever the machine has, and then refused by their number.
bool looksLikeJointTable(const LogText& text, LogFormat format) {
  constexpr int kUsual = 6;
  return jointHeaderOf(text, format, text.options.joints).line > 0 || jointHeaderOf(text, format, kUsual).line > 0;
}

RobotLog readJointTable(const LogText& text, LogFormat format) {
  const int joints = text.options.joints;
  const JointHeader header = jointHeaderOf(text, format, joints);
  if (header.line == 0) {
    throw io::InputError(
        {text.file, 1, ""}, std::string(text.text.substr(0, text.text.find_first_of("\r\n"))),
        format == LogFormat::fanuc_karel
            ? fmt::format("expected a header line as Time [ms];...;J1;...;J{};", joints)
            : fmt::format("expected a header line that names {} joints, as actual_q_0", countedJoints(joints)));
  }
  const DecimalSign sign = text.options.table.decimal_comma ? DecimalSign::comma : DecimalSign::point;
  RobotLog log;
  log.format = format;
  log.radians = format == LogFormat::ur;
  const double angle = log.radians ? 1.0 : io::kDegree;
  if (!header.unread.empty()) log.warnings.push_back(notRead(text, header));
  if (!header.beyond.empty()) log.warnings.push_back(leftOut(text, header.line, header.beyond));
  // A cell and what parts it from the next are a byte each at least.
  log.samples.reserve(std::min(io::linesIn(text.text), text.text.size() / (2 * header.cells - 1) + 1));
  for (const TextLine& line : linesOf(text.text)) {
    if (line.number <= header.line || trimmed(line.text).empty()) continue;
    const std::vector<std::string_view> cells = logCells(line.text, header.separator);
    if (cells.size() != header.cells)
      throw io::InputError({text.file, line.number, ""}, fmt::format("{} cells", cells.size()),
                           fmt::format("expected {} cells, as the header has{}", header.cells,
                                       line.ended ? "" : "; the file ends in the middle of this line"));
    JointSample sample(joints);
    sample.line = line.number;
    for (std::size_t j = 0; j < header.joints.size(); ++j)
      sample.figures[static_cast<Eigen::Index>(j)] =
          decimal(cells[header.joints[j]], sign, text.file, line.number, fmt::format("joint {}", j + 1)) * angle;
    if (header.pose) sample.tool_pose = poseOf(text, cells, line.number, *header.pose, sign);
    if (header.time)
      sample.time_s = decimal(cells[*header.time], sign, text.file, line.number, "time") * header.seconds_per_unit;
    log.samples.push_back(std::move(sample));
  }
  return log;
}

RobotLog readJointColumns(const LogText& text) {
  const FileText file{text.file, text.text, text.options.table};
  if (!hasColumnHeader(file))
    throw io::InputError({text.file, text.options.table.skip + 1, "columns"}, "",
                         "expected the names of its columns (columns), or a header line that has them");
  const ColumnTable table(file);
  const int joints = text.options.joints;
  const JointNames columns = numberedNames("q{}", joints, 1);
  if (!table.hasNumbers(columns.names))
    throw io::InputError({text.file, 0, "columns"}, text.options.table.columns,
                         fmt::format("expected q1 to q{} with their unit, as q1_deg", joints));
  const bool wrench = table.hasAllOrNone({"fx", "fy", "fz", "mx", "my", "mz"});
  const bool position = table.hasAllOrNone({"px", "py", "pz"}), turn = table.hasAllOrNone({"pw", "pp", "pr"});
  if (turn && !position)
    throw io::InputError({text.file, 0, "columns"}, text.options.table.columns,
                         "expected px, py and pz with their unit beside pw, pp and pr");
  RobotLog log;
  log.format = LogFormat::columns;
  log.radians = std::any_of(columns.names.begin(), columns.names.end(),
                            [&](const std::string& name) { return table.isNamed(name, name + "_rad"); });
  log.warnings = table.warnings();
  for (const char* kind : {"q", "m", "c"}) {
    const std::string beyond = kind + std::to_string(joints + 1);
    if (table.hasNumber(beyond)) log.warnings.push_back(leftOut(text, text.options.table.skip + 1, beyond));
  }
  const std::vector<int> motors = jointsOf(table, "m", joints), commands = jointsOf(table, "c", joints);
  const bool indexed = table.has("pose") && table.has("index");
  log.samples.reserve(table.mostRows());
  table.forEachRow([&](const ColumnTable::Row& row) {
    JointSample sample(joints);
    sample.line = row.line;
    sample.name = table.text(row, table.has("pose") ? "pose" : table.has("index") ? "index" : "name");
    if (const std::string step = table.text(row, "step"); !step.empty())
      sample.step = wholeStep(text.file, row.line, step);
    if (const std::string axis = table.text(row, "axis"); !axis.empty())
      sample.axis = wholeStep(text.file, row.line, axis);
    for (Eigen::Index j = 0; j < joints; ++j)
      sample.figures[j] = table.number(row, columns.names[static_cast<std::size_t>(j)]);
    if (const auto time = table.time(row)) sample.time_s = time->seconds;
    if (position)
      sample.tool_pose.position = {table.number(row, "px"), table.number(row, "py"), table.number(row, "pz")};
    if (turn) sample.tool_pose.rpy = {table.number(row, "pw"), table.number(row, "pp"), table.number(row, "pr")};
    if (table.hasNumber("temperature")) sample.temperature_c = table.numberOrBlank(row, "temperature");
    if (wrench) sample.wrench = table.wrench(row);
    if (!motors.empty()) log.motor_side.push_back(anglesIn(table, row, "m", motors, text));
    if (!commands.empty()) log.commanded.push_back(anglesIn(table, row, "c", commands, text));
    if (indexed) log.index.push_back(table.text(row, "index"));
    log.samples.push_back(std::move(sample));
  });
  return log;
}

}  // namespace stiffscope::interchange
