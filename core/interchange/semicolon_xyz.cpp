#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/interchange/length_unit.h"
#include "core/interchange/point_formats.h"
#include "core/io/input_error.h"

namespace stiffscope::interchange {

namespace {

constexpr std::size_t kLeastCells = 4;
constexpr std::array<const char*, 3> kXyz{"x", "y", "z"};

bool isXyzRow(const std::vector<std::string_view>& cells, DecimalSign sign) {
  if (cells.size() < kLeastCells || cells[0].empty()) return false;
  for (std::size_t i = 1; i < kLeastCells; ++i) {
    if (std::isnan(decimalOrNan(cells[i], sign))) return false;
  }
  return std::all_of(cells.begin() + kLeastCells, cells.end(), [](std::string_view cell) { return cell.empty(); });
}

/// Names of columns, where numbers stand below.
bool isHeader(const std::vector<std::string_view>& cells) {
  return std::all_of(cells.begin(), cells.end(), [](std::string_view cell) {
    return std::isnan(decimalOrNan(cell, DecimalSign::point)) && std::isnan(decimalOrNan(cell, DecimalSign::comma));
  });
}

}  // namespace

// By most of the first rows, whatever decimal sign they have: what is wrong in one is said of its line.
bool looksLikeSemicolonXyz(const FileText& text) {
  constexpr std::size_t kLook = 20;
  std::size_t rows = 0, fitting = 0;
  for (const TextLine& line : linesOf(text.text)) {
    if (line.number <= text.options.skip || trimmed(line.text).empty()) continue;
    const std::vector<std::string_view> cells = cellsBetween(line.text, ';');
    if (rows == 0 && isHeader(cells)) return false;
    if (isXyzRow(cells, DecimalSign::point) || isXyzRow(cells, DecimalSign::comma)) ++fitting;
    if (++rows == kLook) break;
  }
  return 2 * fitting >= std::max<std::size_t>(rows, 1);
}

PointFile readSemicolonXyz(const FileText& text) {
  PointFile points;
  points.format = PointFormat::xyz;
  const double unit = unitOrMillimetres(text.file, text.options.unit, points.warnings);
  for (const TextLine& line : linesOf(text.text)) {
    if (line.number <= text.options.skip || trimmed(line.text).empty()) continue;
    const std::vector<std::string_view> cells = cellsBetween(line.text, ';');
    PointReading point;
    point.line = line.number;
    for (std::size_t k = 0; k < kXyz.size(); ++k) {
      if (k + 1 >= cells.size())
        throw io::InputError(
            {text.file, line.number, kXyz[k]}, std::string(line.text),
            std::string("expected NAME;x;y;z") + (line.ended ? "" : "; the file ends in the middle of this line"));
      point.point[static_cast<Eigen::Index>(k)] =
          decimal(cells[k + 1], text.decimalSign(), text.file, line.number, kXyz[k]) * unit;
    }
    if (!isXyzRow(cells, text.decimalSign()))
      throw io::InputError({text.file, line.number, ""}, std::string(line.text),
                           "expected NAME;x;y;z and nothing behind it");
    point.name = cells[0];
    points.points.push_back(std::move(point));
  }
  return points;
}

}  // namespace stiffscope::interchange
