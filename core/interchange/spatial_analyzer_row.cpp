#include "core/interchange/spatial_analyzer_row.h"

#include <fmt/format.h>
#include <algorithm>

namespace stiffscope::interchange {

namespace {

bool isDigitAt(std::string_view text, std::size_t place) {
  return place < text.size() && text[place] >= '0' && text[place] <= '9';
}

bool isHalfOfDay(std::string_view cell) {
  const std::string small = lowered(cell);
  return small == "am" || small == "pm";
}

/// A time of day in a cell, AM or PM behind it or in the next cell.
struct SaTimeOfDay {
  std::string_view time, half;
  std::size_t last = 0;  ///< the cell that it ends in
};

std::optional<SaTimeOfDay> timeOfDayAt(const std::vector<std::string_view>& cells, std::size_t at) {
  constexpr std::size_t kHalf = 2;
  const std::string_view cell = cells[at];
  if (isTimeOfDay(cell)) {
    const bool next = at + 1 < cells.size() && isHalfOfDay(cells[at + 1]);
    return SaTimeOfDay{cell, next ? cells[at + 1] : std::string_view(), next ? at + 1 : at};
  }
  if (cell.size() <= kHalf || !isHalfOfDay(cell.substr(cell.size() - kHalf))) return std::nullopt;
  const std::string_view time = trimmed(cell.substr(0, cell.size() - kHalf));
  if (!isTimeOfDay(time)) return std::nullopt;
  return SaTimeOfDay{time, cell.substr(cell.size() - kHalf), at};
}

/// Three whole numbers between slashes, points or strokes, of a day or not.
bool looksLikeDate(std::string_view cell) {
  const std::size_t separator = cell.find_first_of("/.-");
  if (separator == std::string_view::npos || separator == 0) return false;
  const auto separators = std::count(cell.begin(), cell.end(), cell[separator]);
  const auto digits = std::count_if(cell.begin(), cell.end(), [](char c) { return c >= '0' && c <= '9'; });
  return separators == 2 && digits + 2 == static_cast<std::ptrdiff_t>(cell.size());
}

/// Cuts date and time, or where `lone` a time without its date, out of the cells at `at`, where the time of day is. A
/// time without its day, if it is not the 00:00:00 of a point that nobody measured, is said to be there: no clock can
/// use it.
bool cutTimeAt(std::size_t at, SaRow& row, bool lone) {
  std::vector<std::string_view>& cells = row.cells;
  const auto erase = [&](std::size_t from, std::size_t last) {
    cells.erase(cells.begin() + static_cast<std::ptrdiff_t>(from),
                cells.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    return true;
  };
  const std::string_view cell = cells[at];
  if (cell.find(':') == std::string_view::npos) return false;
  if (const auto clock = timeOfDayAt(cells, at)) {
    if (at > 0 && isDate(cells[at - 1])) {
      row.time = parseTimestamp(fmt::format("{} {} {}", cells[at - 1], clock->time, clock->half));
      return erase(at - 1, clock->last);
    }
    if (!lone) return false;
    const bool nothing = isNoTime(clock->time), date = at > 0 && looksLikeDate(cells[at - 1]);
    if (date && !nothing) return false;  // of another order: which day it is nobody knows
    row.lone_time = !nothing;
    return erase(date ? at - 1 : at, clock->last);
  }
  const bool next = at + 1 < cells.size() && isHalfOfDay(cells[at + 1]);
  std::optional<Timestamp> time;
  if (next) time = parseTimestamp(fmt::format("{} {}", cell, cells[at + 1]));
  const std::size_t last = time ? at + 1 : at;
  if (!time) time = parseTimestamp(cell);
  const std::size_t blank = cell.find(' ');
  const bool nothing = blank != std::string_view::npos && isNoTime(trimmed(cell.substr(blank)));
  if (!time && !nothing) return false;  // left to be refused as no number
  row.time = time;
  return erase(at, last);
}

/// The first cell that has a colon between digits, with the date in front of it.
std::string unreadTimeOf(const std::vector<std::string_view>& cells, std::size_t from) {
  for (std::size_t i = from; i < cells.size(); ++i) {
    const std::size_t colon = cells[i].find(':');
    if (colon == std::string_view::npos || colon == 0 || !isDigitAt(cells[i], colon - 1) ||
        !isDigitAt(cells[i], colon + 1))
      continue;
    return looksLikeDate(cells[i - 1]) ? fmt::format("{} {}", cells[i - 1], cells[i]) : std::string(cells[i]);
  }
  return {};
}

/// The time stands last, or before comments and details of the target, which may look like a time of day; in front of
/// it are at least x y z.
void cutTime(SaRow& row) {
  constexpr std::size_t kLeast = 3;
  for (const bool lone : {false, true}) {
    for (std::size_t at = row.cells.size(); at-- > kLeast;) {
      if (cutTimeAt(at, row, lone)) return;
    }
  }
  row.unread_time = unreadTimeOf(row.cells, kLeast);
}

}  // namespace

SaRow saRowOf(const TextLine& line, const SaSeparator& separator) {
  SaRow row{line.number, line.ended, {}, std::nullopt, false, ""};
  row.cells = separator.comma ? cellsBetween(line.text, ',') : cellsBetweenBlanks(line.text, separator.blanks);
  // A separator behind the last cell ends nothing.
  if (separator.comma && !row.cells.empty() && row.cells.back().empty()) row.cells.pop_back();
  cutTime(row);
  return row;
}

}  // namespace stiffscope::interchange
