#include "core/interchange/taught_program.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/interchange/delimited_text.h"
#include "core/interchange/robot_log.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/units.h"

namespace stiffscope::interchange {

namespace {

/// All grammars are ASCII. Other bytes, of comments, become '?', so that places in the text are those in the file.
std::string asciiOf(const std::string& file, std::string_view bytes) {
  if (bytes.find('\0') != std::string_view::npos)
    throw io::InputError({file, 0, ""}, "", "expected a program of one byte a character; it is UTF-16, or none");
  std::string text(bytes);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) >= 0x80) c = '?';
  }
  return text;
}

/// A figure in degrees without the sign of a zero.
std::string writtenFigure(double degrees, int decimals) {
  std::string text = fmt::format("{:.{}f}", degrees, decimals);
  if (text.starts_with('-') && text.find_first_of("123456789") == std::string::npos) text.erase(0, 1);
  return text;
}

[[noreturn]] void refuseWithoutJoints(const std::string& file, const SkippedRow& first) {
  if (first.reason == Skip::joints_computed)
    throw io::InputError({file, first.line, ""}, "",
                         "expected joint targets with their angles; this one is computed, given in part or handed on");
  throw io::InputError(
      {file, first.line, ""}, "",
      "expected joint targets; this one is in space, and which joint angles the controller takes for it "
      "is not in the file: have the targets stored as joints, or use --path");
}

}  // namespace

TaughtProgram parseTaughtProgram(const std::string& file, std::string_view bytes, int joints) {
  TaughtProgram program{file, std::string(bytes), {}, 3};
  const std::string text = asciiOf(file, bytes);
  LogOptions options;
  options.joints = joints;
  options.in_instructions = true;
  options.joints_needed = false;
  program.log = parseRobotLog(file, text, options);
  switch (program.log.format) {
    case LogFormat::fanuc_tp:
      break;
    case LogFormat::kuka_krl:
    case LogFormat::rapid:
      program.decimals = 4;
      break;
    case LogFormat::fanuc_karel:
    case LogFormat::ur:
    case LogFormat::columns:
      throw io::InputError({file, 0, ""}, nameOf(program.log.format),
                           "expected a program: FANUC's .ls, KRL's .src or .dat, or a RAPID module");
  }
  if (program.log.samples.empty()) {
    if (!program.log.skipped.empty()) refuseWithoutJoints(file, program.log.skipped.front());
    throw io::InputError({file, 0, ""}, "", "expected joint targets; there are none");
  }
  return program;
}

TaughtProgram readTaughtProgram(const std::filesystem::path& path, int joints) {
  return parseTaughtProgram(path.string(), io::readBytesWithStamp(path).text(), joints);
}

int decimalsOfTarget(const TaughtProgram& program, std::size_t target) {
  int decimals = program.decimals;
  for (const TextSpan& place : program.log.places[target])
    decimals = std::max(decimals, decimalsOf(std::string_view(program.bytes).substr(place.from, place.size)));
  return decimals;
}

std::string withFigures(const TaughtProgram& program, const std::vector<std::optional<JointVector>>& figures) {
  struct Edit {
    TextSpan place;
    std::string text;
  };
  std::vector<Edit> edits;
  for (std::size_t i = 0; i < program.log.samples.size(); ++i) {
    if (!figures[i]) continue;
    const int decimals = decimalsOfTarget(program, i);
    for (Eigen::Index joint = 0; joint < figures[i]->size(); ++joint) {
      std::string text = writtenFigure((*figures[i])[joint] / io::kDegree, decimals);
      if (text == writtenFigure(program.log.samples[i].figures[joint] / io::kDegree, decimals)) continue;
      edits.push_back({program.log.places[i][static_cast<std::size_t>(joint)], std::move(text)});
    }
  }
  std::sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.place.from < b.place.from; });
  std::string bytes;
  bytes.reserve(program.bytes.size() + 8 * edits.size());
  std::size_t at = 0;
  for (const Edit& edit : edits) {
    bytes.append(program.bytes, at, edit.place.from - at);
    bytes += edit.text;
    at = edit.place.from + edit.place.size;
  }
  return bytes.append(program.bytes, at);
}

}  // namespace stiffscope::interchange
