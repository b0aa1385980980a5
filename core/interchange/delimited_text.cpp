#include "core/interchange/delimited_text.h"

#include <fmt/format.h>
#include <algorithm>
#include <limits>

#include "core/io/input_error.h"
#include "core/io/numbers.h"

namespace stiffscope::interchange {

namespace {

constexpr std::string_view kNoBreakSpace = "\xC2\xA0";

bool isBlank(char c) { return c == ' ' || c == '\t'; }

bool isDigit(char c) { return c >= '0' && c <= '9'; }

bool isQuoted(std::string_view cell) { return cell.size() >= 2 && cell.front() == '"' && cell.back() == '"'; }

/// The quotes around a cell stay where it has some in it, too: a view cannot leave out one of two (cellText does).
std::string_view unquoted(std::string_view cell) {
  if (!isQuoted(cell)) return cell;
  const std::string_view inside = cell.substr(1, cell.size() - 2);
  return inside.find("\"\"") == std::string_view::npos ? trimmed(inside) : cell;
}

/// Where the quote that opens at `opening` closes, two in a row being a letter; npos where it does not.
std::size_t closingQuote(std::string_view line, std::size_t opening) {
  for (std::size_t at = line.find('"', opening + 1); at != std::string_view::npos; at = line.find('"', at + 2)) {
    if (at + 1 == line.size() || line[at + 1] != '"') return at;
  }
  return std::string_view::npos;
}

}  // namespace

LinesOfText::Iterator& LinesOfText::Iterator::operator++() {
  at_end_ = rest_.empty();
  if (at_end_) return *this;
  const std::size_t end = rest_.find_first_of("\r\n");
  const bool ended = end != std::string_view::npos;
  line_ = {rest_.substr(0, end), line_.number + 1, ended};
  const bool both = ended && rest_[end] == '\r' && end + 1 < rest_.size() && rest_[end + 1] == '\n';
  rest_.remove_prefix(ended ? end + (both ? 2 : 1) : rest_.size());
  return *this;
}

void requireLines(const std::string& file, std::string_view text) {
  constexpr std::size_t kLongest = std::size_t{1} << 20;
  for (const TextLine& line : linesOf(text)) {
    if (line.text.size() <= kLongest) continue;
    throw io::InputError(
        {file, line.number, ""}, io::oneLine(line.text.substr(0, 200), 60),
        fmt::format("expected lines of at most {} bytes; this one has {}", kLongest, line.text.size()));
  }
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty()) {
    if (isBlank(text.front())) {
      text.remove_prefix(1);
    } else if (text.starts_with(kNoBreakSpace)) {
      text.remove_prefix(kNoBreakSpace.size());
    } else {
      break;
    }
  }
  while (!text.empty()) {
    if (isBlank(text.back())) {
      text.remove_suffix(1);
    } else if (text.ends_with(kNoBreakSpace)) {
      text.remove_suffix(kNoBreakSpace.size());
    } else {
      break;
    }
  }
  return text;
}

std::vector<std::string_view> cellsBetween(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  while (true) {
    // A separator in quotes belongs to the cell.
    const std::string_view start = trimmed(line);
    std::size_t from = 0;
    if (!start.empty() && start.front() == '"') {
      const auto opening = static_cast<std::size_t>(start.data() - line.data());
      const std::size_t closing = closingQuote(line, opening);
      if (closing != std::string_view::npos) from = closing;
    }
    const std::size_t end = line.find(separator, from);
    cells.push_back(unquoted(trimmed(line.substr(0, end))));
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

std::string cellText(std::string_view cell) {
  if (!isQuoted(cell) || cell.find("\"\"", 1) >= cell.size() - 2) return std::string(cell);
  std::string text;
  for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"' && i + 2 < cell.size() && cell[i + 1] == '"') ++i;
  }
  return std::string(trimmed(text));
}

std::vector<std::string_view> cellsBetweenBlanks(std::string_view line, std::size_t least) {
  std::vector<std::string_view> cells;
  line = trimmed(line);
  std::size_t from = 0;
  for (std::size_t i = 0; i < line.size();) {
    if (!isBlank(line[i])) {
      ++i;
      continue;
    }
    std::size_t end = i, width = 0;
    for (; end < line.size() && isBlank(line[end]); ++end) width += line[end] == '\t' ? least : 1;
    if (width >= least) {
      cells.push_back(unquoted(line.substr(from, i - from)));
      from = end;
    }
    i = end;
  }
  if (from < line.size()) cells.push_back(unquoted(line.substr(from)));
  return cells;
}

std::size_t longestBlanks(std::string_view line) {
  line = trimmed(line);
  std::size_t longest = 0, run = 0;
  for (const char c : line) {
    run = c == ' ' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

double decimalOrNan(std::string_view cell, DecimalSign sign) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (sign == DecimalSign::comma) {
    if (cell.find('.') != std::string_view::npos) return kNone;
    std::string with_point(cell);
    std::replace(with_point.begin(), with_point.end(), ',', '.');
    return decimalOrNan(with_point, DecimalSign::point);
  }
  // Controllers write -.000 and 12. as well as +1.5.
  const io::ParsedNumber number = io::parseNumber(cell);
  return number.expectation.empty() ? number.value : kNone;
}

double decimal(std::string_view cell, DecimalSign sign, const std::string& file, std::size_t line,
               const std::string& column) {
  const double value = decimalOrNan(cell, sign);
  if (value == value) return value;
  std::string expectation = io::parseNumber(cell).expectation;
  if (sign == DecimalSign::comma && decimalOrNan(cell, DecimalSign::point) == decimalOrNan(cell, DecimalSign::point))
    expectation = "expected a number with a decimal comma, as was said of this file; this one has a point";
  if (sign == DecimalSign::comma && expectation.find("decimal comma") != std::string::npos &&
      expectation.find("as was said") == std::string::npos)
    expectation = "expected a number with a decimal comma";
  if (sign == DecimalSign::point && looksLikeDecimalComma(cell))
    expectation = "expected a number with a decimal point; this one has a comma (option decimal-comma)";
  throw io::InputError({file, line, column}, std::string(cell), expectation);
}

int decimalsOf(std::string_view cell) {
  if (cell.find_first_of("eE") != std::string_view::npos) return -1;
  const std::size_t sign = cell.find_first_of(".,");
  return sign == std::string_view::npos ? 0 : static_cast<int>(cell.size() - sign - 1);
}

bool looksLikeDecimalComma(std::string_view cell) {
  if (!cell.empty() && (cell.front() == '-' || cell.front() == '+')) cell.remove_prefix(1);
  const std::size_t comma = cell.find(',');
  if (comma == std::string_view::npos || comma + 1 >= cell.size()) return false;
  return std::all_of(cell.begin(), cell.end(),
                     [](char c) { return isDigit(c) || c == ',' || c == 'e' || c == 'E' || c == '-' || c == '+'; }) &&
         cell.find(',', comma + 1) == std::string_view::npos && isDigit(cell[comma + 1]);
}

std::string lowered(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return small;
}

}  // namespace stiffscope::interchange
