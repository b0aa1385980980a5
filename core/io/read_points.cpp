#include "core/io/read_points.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>

#include "core/io/input_error.h"
#include "core/io/numbers.h"
#include "core/io/read_file.h"

namespace stiffscope::io {

namespace {

constexpr std::array kColumns{"x", "y", "z"};

/// A comma or a semicolon ends a cell, and nothing between two of them is an empty cell; blanks end one where
/// there is something.
std::vector<std::string_view> cellsOf(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r\f\v";
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> cells;
  bool after_separator = false;
  while (true) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) break;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(" \t\r\f\v,;"), line.size());
    cells.push_back(line.substr(0, end));
    line.remove_prefix(end);
    const std::size_t next = line.find_first_not_of(kBlanks);
    after_separator = next != std::string_view::npos && (line[next] == ',' || line[next] == ';');
    if (after_separator) line.remove_prefix(next + 1);
  }
  if (after_separator) cells.push_back({});
  return cells;
}

/// One whole number alone on the first line.
std::optional<int> countIn(const std::vector<std::string_view>& cells) {
  return cells.size() == 1 ? parseInteger(cells[0]) : std::nullopt;
}

constexpr const char* kNoHeader = "; a file of points has no header line, or one that begins with #";

bool startsName(std::string_view cell) {
  return !cell.empty() && (std::isalpha(static_cast<unsigned char>(cell[0])) != 0 || cell[0] == '"');
}

Eigen::Vector3d pointIn(const std::vector<std::string_view>& cells, const std::string& file, std::size_t line,
                        bool first) {
  Eigen::Vector3d point;
  for (std::size_t k = 0; k < std::min(cells.size(), kColumns.size()); ++k) {
    const ParsedNumber number = parseNumber(cells[k]);
    if (!number.expectation.empty()) {
      throw InputError({file, line, kColumns[k]}, std::string(cells[k]),
                       number.expectation + (first && startsName(cells[k]) ? kNoHeader : ""));
    }
    point[static_cast<Eigen::Index>(k)] = number.value;
  }
  if (cells.size() < kColumns.size()) {
    throw InputError({file, line, kColumns[cells.size()]}, "",
                     "expected three numbers, x y z; the line ends before this one");
  }
  if (cells.size() > kColumns.size()) {
    throw InputError({file, line, "4"}, std::string(cells[3]),
                     "expected three numbers, x y z, with decimal points; the line has more");
  }
  return point;
}

}  // namespace

std::vector<Eigen::Vector3d> parsePoints(std::string_view bytes, const std::string& file) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string_view rest = bytes;
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  std::vector<Eigen::Vector3d> points;
  std::optional<int> count;
  std::size_t count_line = 0;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    std::size_t end = rest.find('\n');
    // Old Macs end lines with a CR alone; one before the LF is a blank of the last cell.
    const std::size_t cr = rest.substr(0, end).find('\r');
    if (cr != std::string_view::npos && cr + 1 != end) end = cr;
    const auto cells = cellsOf(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (cells.empty()) continue;
    if (points.empty() && !count && countIn(cells)) {
      count = countIn(cells);
      count_line = line;
      continue;
    }
    points.push_back(pointIn(cells, file, line, points.empty()));
  }
  if (points.empty()) throw InputError({file, 0, ""}, "", "expected points, x y z on each line; there are none");
  if (count && (*count < 0 || static_cast<std::size_t>(*count) != points.size())) {
    throw InputError({file, count_line, "count"}, fmt::format("{}", *count),
                     fmt::format("expected the number of points that follow, {}", points.size()));
  }
  return points;
}

std::vector<Eigen::Vector3d> readPoints(const std::filesystem::path& file) {
  return parsePoints(readTextFile(file), file.string());
}

}  // namespace stiffscope::io
