#include "core/interchange/robot_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

#include "core/interchange/log_formats.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/units.h"

namespace stiffscope::interchange {

LogFormat logFormatNamed(const std::string& name, const std::string& option) {
  for (std::size_t i = 0; i < kLogFormatNames.size(); ++i) {
    if (name == kLogFormatNames[i]) return static_cast<LogFormat>(i);
  }
  const std::vector<std::string> known(kLogFormatNames.begin(), kLogFormatNames.end());
  throw io::InputError({option}, name,
                       fmt::format("expected {}{}", fmt::join(known, ", "), io::nearestNameHint(name, known)));
}

namespace {

std::optional<LogFormat> shownFormat(const LogText& text) {
  if (!text.options.table.columns.empty()) return LogFormat::columns;
  if (looksLikeFanucProgram(text.text)) return LogFormat::fanuc_tp;
  if (looksLikeJointTable(text, LogFormat::fanuc_karel)) return LogFormat::fanuc_karel;
  if (hasColumnHeader({text.file, text.text, text.options.table})) return LogFormat::columns;
  if (looksLikeJointTable(text, LogFormat::ur)) return LogFormat::ur;
  if (looksLikeRapid(text)) return LogFormat::rapid;
  if (looksLikeKukaData(text)) return LogFormat::kuka_krl;
  return std::nullopt;
}

LogFormat formatOf(const LogText& text) {
  const std::optional<LogFormat> shown = shownFormat(text);
  const std::optional<LogFormat>& wanted = text.options.format;
  if (wanted && (!shown || *shown == *wanted)) return *wanted;
  const std::string_view first = trimmed(text.text.substr(0, text.text.find_first_of("\r\n")));
  if (wanted)
    throw io::InputError({text.file, 0, "format"}, nameOf(*wanted),
                         fmt::format("expected {}, as this file is built", nameOf(*shown)));
  if (!shown)
    throw io::InputError(
        {text.file, 1, ""}, std::string(first),
        fmt::format("expected joints: {}; it is built like none of them", fmt::join(kLogFormatNames, ", ")));
  return *shown;
}

RobotLog readAs(LogFormat format, const LogText& text) {
  switch (format) {
    case LogFormat::fanuc_karel:
    case LogFormat::ur:
      return readJointTable(text, format);
    case LogFormat::fanuc_tp:
      return readFanucProgram(text);
    case LogFormat::kuka_krl:
      return readKukaData(text);
    case LogFormat::rapid:
      return readRapid(text);
    case LogFormat::columns:
      break;
  }
  return readJointColumns(text);
}

/// A log's clock runs forwards; a controller's counter of milliseconds may stand for a sample.
void requireOrder(const std::string& file, const RobotLog& log) {
  for (std::size_t i = 1; i < log.samples.size(); ++i) {
    const auto &before = log.samples[i - 1].time_s, &now = log.samples[i].time_s;
    if (!before || !now || *now >= *before) continue;
    throw io::InputError(
        {file, log.samples[i].line, "time"}, fmt::format("{:.3f} s", *now),
        fmt::format("expected a time not before that of the row above, {:.3f} s: two logs in one file?", *before));
  }
}

void requirePlausible(const std::string& file, const RobotLog& log) {
  constexpr double kMost = 720.0 * io::kDegree;
  // Figures in degrees are too large as radians; those in radians are small as degrees, and plausible.
  const char* const meant = log.radians ? "degrees read as radians, or another column?" : "another column?";
  for (const JointSample& sample : log.samples) {
    for (Eigen::Index j = 0; j < sample.figures.size(); ++j) {
      if (std::abs(sample.figures[j]) <= kMost) continue;
      throw io::InputError({file, sample.line, fmt::format("joint {}", j + 1)},
                           fmt::format("{:.6g} deg", sample.figures[j] / io::kDegree),
                           fmt::format("expected an angle within +-720 deg: {}", meant));
    }
    // As the campaign's tables have it; of poses that are not stated both are false.
    constexpr double kFarthest = 200.0;
    const campaign::StatedPose& pose = sample.tool_pose;
    if ((pose.position.array().abs() > kFarthest).any() || (pose.rpy.array().abs() > kMost).any())
      throw io::InputError({file, sample.line, "pose"}, "",
                           "expected a position of the tool within +-200 m, and turns within +-720 deg");
  }
}

/// Poses that stay where they are while joints move are columns that nobody filled.
void dropEmptyPoses(const std::string& file, RobotLog& log) {
  if (log.samples.empty()) return;
  constexpr double kMoves = 1.0 * io::kDegree;
  const JointSample& first = log.samples.front();
  if (!first.tool_pose.hasPosition()) return;
  double moved = 0.0;
  for (const JointSample& sample : log.samples) {
    if (sample.tool_pose.position != first.tool_pose.position) return;
    moved = std::max(moved, (sample.figures - first.figures).cwiseAbs().maxCoeff());
  }
  if (moved < kMoves) return;
  for (JointSample& sample : log.samples) sample.tool_pose = {};
  log.warnings.push_back(io::inputMessage({file, first.line, "pose"}, "",
                                          "the position of the tool never changes while joints move: it is not taken"));
}

}  // namespace

RobotLog parseRobotLog(const std::string& file, std::string_view bytes, const LogOptions& options) {
  const DecodedText decoded = decodeText(file, bytes, options.table.encoding);
  const LogText text{file, decoded.text(), options};
  requireLines(file, text.text);
  RobotLog log = readAs(formatOf(text), text);
  log.encoding = decoded.encoding;
  if (log.samples.empty() && options.joints_needed)
    throw io::InputError({file, 0, ""}, "", "expected joint angles; there are none");
  if (options.rate_hz) {
    for (std::size_t i = 0; i < log.samples.size(); ++i) {
      if (log.samples[i].time_s)
        throw io::InputError({file, log.samples[i].line, "rate_hz"}, fmt::format("{:g}", *options.rate_hz),
                             "expected no rate: this log has times of its own");
      log.samples[i].time_s = static_cast<double>(i) / *options.rate_hz;
    }
  }
  requireOrder(file, log);
  requirePlausible(file, log);
  dropEmptyPoses(file, log);
  return log;
}

RobotLog readRobotLog(const std::filesystem::path& path, const LogOptions& options) {
  return parseRobotLog(path.string(), io::readBytesWithStamp(path).text(), options);
}

}  // namespace stiffscope::interchange
