#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/interchange/length_unit.h"
#include "core/interchange/point_formats.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"

namespace stiffscope::interchange {

namespace {

constexpr std::string_view kComment = "//";
constexpr std::array<const char*, 3> kAxisLetters{"x", "y", "z"};

/// How the cells of the rows are kept apart.
struct SaSeparator {
  bool comma = false;
  std::size_t blanks = 1;  ///< at least so many between two cells; of commas without meaning
};

std::vector<std::string_view> saCellsOf(std::string_view line, const SaSeparator& separator) {
  return separator.comma ? cellsBetween(line, ',') : cellsBetweenBlanks(line, separator.blanks);
}

/// A row with its time, if any, cut off.
struct SaRow {
  std::size_t line = 0;
  bool ended = true;
  std::vector<std::string_view> cells;
  std::optional<Timestamp> time;
  bool lone_time = false;  ///< a time of day without its date, which is not read
};

/// What the comments say.
struct SaHeader {
  std::string frame;
  std::optional<double> unit;
  std::string unit_word;             ///< a unit's name that stands elsewhere than with the axes
  std::optional<int> uncertainties;  ///< cells a row has of them; nullopt: the axes are not commented
  double coverage = 0.0;             ///< k; 0: not said
  bool any = false;
};

/// The first text between two equal marks that holds '::'.
std::string frameIn(std::string_view comment) {
  const std::size_t colons = comment.find("::");
  if (colons == std::string_view::npos) return {};
  for (const std::string_view mark : {"'", "\"", "`", "\xE2\x80\x98", "\xE2\x80\x99", "\xC2\xB4"}) {
    const std::size_t open = comment.rfind(mark, colons);
    if (open == std::string_view::npos) continue;
    std::string_view rest = comment.substr(open + mark.size());
    const std::size_t close =
        std::min({rest.find('\''), rest.find('"'), rest.find("\xE2\x80\x99"), rest.find("\xC2\xB4")});
    if (close != std::string_view::npos) return std::string(rest.substr(0, close));
  }
  // Without marks: the word that the colons are in.
  const std::size_t from = comment.find_last_of(" \t", colons) + 1;
  return std::string(comment.substr(from, comment.find_first_of(" \t", colons) - from));
}

/// Texts between round or square brackets.
std::vector<std::string_view> bracketed(std::string_view comment) {
  std::vector<std::string_view> found;
  while (true) {
    const std::size_t open = comment.find_first_of("([");
    if (open == std::string_view::npos) return found;
    comment.remove_prefix(open);
    const std::size_t close = comment.find(comment.front() == '(' ? ')' : ']');
    if (close == std::string_view::npos) return found;
    found.push_back(trimmed(comment.substr(1, close - 1)));
    comment.remove_prefix(close);
  }
}

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c & 0x80) != 0; }

/// Words of letters, digits left out: "u-x" gives u and x.
std::vector<std::string> wordsOf(std::string_view comment) {
  std::vector<std::string> found(1);
  for (const char c : lowered(comment)) {
    if (isLetter(c)) {
      found.back() += c;
    } else if (!found.back().empty()) {
      found.emplace_back();
    }
  }
  if (found.back().empty()) found.pop_back();
  return found;
}

bool namesAxes(const std::vector<std::string>& words) {
  return std::all_of(kAxisLetters.begin(), kAxisLetters.end(),
                     [&](const char* axis) { return std::find(words.begin(), words.end(), axis) != words.end(); });
}

/// Labels of uncertainties: U-x U-y U-z U-mag, whatever stands between the letters.
int uncertaintiesNamed(std::string_view comment) {
  int count = 0;
  const std::vector<std::string> words = wordsOf(comment);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool apart =
        words[i] == "u" && i + 1 < words.size() &&
        (words[i + 1] == "x" || words[i + 1] == "y" || words[i + 1] == "z" || words[i + 1].starts_with("mag"));
    const bool together = words[i] == "ux" || words[i] == "uy" || words[i] == "uz" || words[i].starts_with("umag");
    count += apart || together ? 1 : 0;
  }
  return count;
}

/// The number that ends where `end` is; NaN where there is none.
double numberBefore(std::string_view text, std::size_t end) {
  while (end > 0 && text[end - 1] == ' ') --end;
  std::size_t from = end;
  while (from > 0 && (std::string_view("0123456789.,").find(text[from - 1]) != std::string_view::npos)) --from;
  std::string_view digits = text.substr(from, end - from);
  while (digits.starts_with(',') || digits.starts_with('.')) digits.remove_prefix(1);
  return decimalOrNan(digits, digits.find(',') != std::string_view::npos ? DecimalSign::comma : DecimalSign::point);
}

/// The coverage factor that a comment states: "2 sigma", or a level of confidence, of which 95 % is k = 2 as the Guide
/// has it. 0: it states none.
double coverageIn(std::string_view comment) {
  const std::string small = lowered(comment);
  const std::size_t sigma = std::min(small.find("sigm"), small.find("\xCF\x83"));
  if (sigma != std::string::npos) {
    const double factor = numberBefore(small, sigma);
    if (factor > 0.0 && factor <= 5.0) return factor;
  }
  const std::size_t percent = small.find('%');
  if (percent == std::string::npos) return 0.0;
  const double level = numberBefore(small, percent);
  struct Level {
    double percent, factor;
  };
  constexpr std::array<Level, 3> kLevels{{{68.0, 1.0}, {95.0, 2.0}, {99.7, 3.0}}};
  for (const Level& known : kLevels) {
    if (std::abs(level - known.percent) < 0.6) return known.factor;
  }
  return 0.0;
}

void readSaComment(const FileText& text, const TextLine& line, std::string_view comment, SaHeader& header) {
  header.any = true;
  if (header.frame.empty()) header.frame = frameIn(comment);
  if (header.coverage == 0.0) header.coverage = coverageIn(comment);
  const std::vector<std::string> words = wordsOf(comment);
  const bool axes = namesAxes(words);
  // Short names (in, m) are words of many languages; of the long ones none is.
  constexpr std::size_t kLongName = 4;
  for (const std::string& word : words) {
    if (word.size() >= kLongName && metresIn(word)) header.unit_word = word;
  }
  if (axes)
    header.uncertainties = uncertaintiesNamed(comment);
  else if (header.uncertainties)
    *header.uncertainties += uncertaintiesNamed(comment);
  for (const std::string_view unit : bracketed(comment)) {
    const std::string small = lowered(unit);
    if (small.find("deg") != std::string::npos || small.find("rad") != std::string::npos ||
        small.find("grad") != std::string::npos) {
      throw io::InputError({text.file, line.number, ""}, std::string(comment),
                           "expected Cartesian axes; these have an angle: export x, y, z");
    }
    if (!axes) continue;
    // Several of one axis comment: "X (mm), Y (mm), Z (mm)".
    const std::string first = small.substr(0, small.find_first_of(",; "));
    const std::optional<double> metres = metresIn(first);
    if (!metres) {
      throw io::InputError({text.file, line.number, "unit"}, std::string(unit),
                           "expected mm, m or inch in the comment of the axes");
    }
    if (header.unit && *header.unit != *metres)
      throw io::InputError({text.file, line.number, "unit"}, std::string(unit), "expected one unit for all axes");
    header.unit = metres;
  }
}

/// Cuts date and time, or a lone time, off the end. A time without its day, if it is not the 00:00:00 of a point that
/// nobody measured, is said to be there: no clock can use it.
void cutTime(std::vector<std::string_view>& cells, std::optional<Timestamp>& time, bool& lone) {
  if (cells.empty()) return;
  const std::string_view last = cells.back();
  const bool two = cells.size() > 1 && isTimeOfDay(last) && isDate(cells[cells.size() - 2]);
  if (two) {
    time = parseTimestamp(fmt::format("{} {}", cells[cells.size() - 2], last));
    cells.resize(cells.size() - 2);
  } else if (isTimeOfDay(last)) {
    lone = !isNoTime(last);
    cells.pop_back();
  } else if (last.find(':') != std::string_view::npos) {
    time = parseTimestamp(last);
    const std::size_t blank = last.find(' ');
    const bool nothing = blank != std::string_view::npos && isNoTime(trimmed(last.substr(blank)));
    if (!time && !nothing) return;  // left to be refused as no number
    cells.pop_back();
  }
}

std::vector<TextLine> rowLines(const FileText& text, std::size_t most = std::numeric_limits<std::size_t>::max()) {
  std::vector<TextLine> rows;
  for (const TextLine& line : linesOf(text.text)) {
    const std::string_view content = trimmed(line.text);
    if (line.number <= text.options.skip || content.empty() || content.starts_with(kComment)) continue;
    if (rows.size() == most) break;
    rows.push_back({content, line.number, line.ended});
  }
  return rows;
}

SaHeader headerOf(const FileText& text) {
  SaHeader header;
  for (const TextLine& line : linesOf(text.text)) {
    const std::string_view content = trimmed(line.text);
    if (content.starts_with(kComment)) readSaComment(text, line, trimmed(content.substr(kComment.size())), header);
  }
  return header;
}

SaSeparator separatorOf(const FileText& text, const std::vector<TextLine>& rows) {
  const auto every = [&](const auto& holds) { return std::all_of(rows.begin(), rows.end(), holds); };
  const bool comma = every([](const TextLine& row) { return row.text.find(',') != std::string_view::npos; });
  constexpr std::size_t kApart = 2;
  const bool wide = every([](const TextLine& row) {
    return longestBlanks(row.text) >= kApart || row.text.find('\t') != std::string_view::npos;
  });
  const std::size_t blanks = wide ? kApart : 1;
  if (text.options.decimal_comma) return {false, blanks};
  // "Main   1   2296,337   -2416,231": every comma is inside a number.
  const bool decimal =
      comma && every([&](const TextLine& row) {
        const auto cells = cellsBetweenBlanks(row.text, 1);
        return std::none_of(cells.begin(), cells.end(), [](std::string_view cell) { return cell.ends_with(','); }) &&
               std::any_of(cells.begin(), cells.end(), looksLikeDecimalComma);
      });
  if (decimal) {
    throw io::InputError({text.file, rows.front().number, ""}, std::string(rows.front().text),
                         "expected decimal points; these numbers have commas (option decimal-comma)");
  }
  return {comma, blanks};
}

/// Whether cells are coordinates: numbers with the same count of decimals, which names seldom have.
bool areCoordinates(const std::vector<std::string_view>& cells, std::size_t from, DecimalSign sign) {
  if (from + 3 > cells.size()) return false;
  const int decimals = decimalsOf(cells[from]);
  for (std::size_t i = from; i < from + 3; ++i) {
    if (std::isnan(decimalOrNan(cells[i], sign)) || decimalsOf(cells[i]) != decimals) return false;
  }
  return true;
}

/// Uncertainties are none below zero, and a fourth is the root of the sum of their squares.
bool areUncertainties(const std::vector<std::string_view>& cells, std::size_t from, DecimalSign sign) {
  double squares = 0.0;
  for (std::size_t i = from; i < from + 3; ++i) {
    const double value = decimalOrNan(cells[i], sign);
    if (!(value >= 0.0)) return false;
    squares += value * value;
  }
  if (cells.size() < from + 4) return true;
  const double whole = decimalOrNan(cells[from + 3], sign);
  const int decimals = decimalsOf(cells[from + 3]);
  const double rounding = decimals < 0 ? 1e-3 * whole : 3.0 * std::pow(10.0, -decimals);
  return std::abs(whole - std::sqrt(squares)) <= rounding;
}

constexpr std::size_t kMostNames = 3;

/// Whether a row can have that many names: what follows x y z is nothing, two target offsets, or uncertainties.
bool fitsNames(const SaRow& row, std::size_t names, DecimalSign sign) {
  if (!areCoordinates(row.cells, names, sign)) return false;
  const std::size_t behind = row.cells.size() - names - 3;
  if (behind == 0) return true;
  for (std::size_t i = names + 3; i < row.cells.size(); ++i) {
    if (std::isnan(decimalOrNan(row.cells[i], sign))) return false;
  }
  if (behind == 2) return true;
  return (behind == 3 || behind == 4) && areUncertainties(row.cells, names + 3, sign);
}

/// How many names can stand before the coordinates of all rows, and the first row that none is left for.
struct PossibleNames {
  std::vector<std::size_t> counts;
  const SaRow* misfit = nullptr;
};

PossibleNames possibleNames(const std::vector<SaRow>& rows, DecimalSign sign) {
  PossibleNames possible;
  for (std::size_t names = 0; names <= kMostNames; ++names) possible.counts.push_back(names);
  for (const SaRow& row : rows) {
    std::erase_if(possible.counts, [&](std::size_t names) { return !fitsNames(row, names, sign); });
    if (!possible.counts.empty()) continue;
    possible.misfit = &row;
    break;
  }
  return possible;
}

[[noreturn]] void refuseRow(const FileText& text, const SaRow& row) {
  const bool cut = !row.ended;
  for (std::size_t i = 0; i < row.cells.size() && i < kMostNames + 3; ++i) {
    if (text.decimalSign() == DecimalSign::point && looksLikeDecimalComma(row.cells[i]))
      decimal(row.cells[i], DecimalSign::point, text.file, row.line, "");
  }
  throw io::InputError({text.file, row.line, ""}, fmt::format("{}", fmt::join(row.cells, " | ")),
                       std::string("expected up to three names, x y z with the same decimals, and behind them nothing, "
                                   "two target offsets, or three or four uncertainties, and a time") +
                           (cut ? "; the file ends in the middle of this line" : ""));
}

/// The count of names that all rows have.
std::size_t namesOf(const FileText& text, const std::vector<SaRow>& rows, const SaHeader& header) {
  const DecimalSign sign = text.decimalSign();
  const PossibleNames fitting = possibleNames(rows, sign);
  if (fitting.misfit != nullptr) refuseRow(text, *fitting.misfit);
  std::vector<std::size_t> possible = fitting.counts;
  if (possible.size() > 1 && header.uncertainties) {
    const auto most = std::max_element(rows.begin(), rows.end(), [](const SaRow& a, const SaRow& b) {
                        return a.cells.size() < b.cells.size();
                      })->cells.size();
    const auto said = most - 3 - static_cast<std::size_t>(*header.uncertainties);
    if (std::find(possible.begin(), possible.end(), said) != possible.end()) possible = {said};
  }
  if (possible.size() > 1) {
    throw io::InputError({text.file, rows.front().line, ""}, fmt::format("{}", fmt::join(rows.front().cells, " | ")),
                         fmt::format("expected rows that can be read in one way; there may be {} names before x y z: "
                                     "name the columns (format columns)",
                                     fmt::join(possible, " or ")));
  }
  return possible.front();
}

/// Metres in the unit of the axes. A unit that the comments name elsewhere, or another than the user's, is no unit to
/// be taken for granted.
double saUnitOf(const FileText& text, const SaHeader& header, std::vector<std::string>& warnings) {
  const std::string& stated = text.options.unit;
  if (!header.unit) {
    if (stated.empty() && !header.unit_word.empty())
      throw io::InputError({text.file, 0, "unit"}, header.unit_word,
                           "expected the unit in the comment of the axes, as X, Y, Z (mm); this one stands elsewhere: "
                           "state the unit (option unit)");
    return unitOrMillimetres(text.file, stated, warnings);
  }
  if (!stated.empty() && metresIn(stated) != header.unit)
    throw io::InputError({text.file, 0, "unit"}, stated,
                         "expected no unit, or that of the file's comments, which state another");
  return *header.unit;
}

/// A last number that lacks digits was cut off with the file.
void requireWhole(const FileText& text, const std::vector<SaRow>& rows, const std::vector<TextLine>& lines) {
  if (rows.size() < 2 || lines.back().ended || rows.back().time) return;
  const auto &last = rows.back().cells, &before = rows[rows.size() - 2].cells;
  if (last.empty() || before.empty() || last.size() != before.size()) return;
  if (decimalsOf(last.back()) >= decimalsOf(before.back())) return;
  throw io::InputError({text.file, rows.back().line, ""}, std::string(last.back()),
                       "expected as many decimals as above; the file ends in the middle of this number");
}

std::vector<SaRow> saRowsOf(const std::vector<TextLine>& lines, const SaSeparator& separator) {
  std::vector<SaRow> rows;
  for (const TextLine& line : lines) {
    SaRow row{line.number, line.ended, saCellsOf(line.text, separator), std::nullopt, false};
    // A separator behind the last cell ends nothing.
    if (separator.comma && !row.cells.empty() && row.cells.back().empty()) row.cells.pop_back();
    cutTime(row.cells, row.time, row.lone_time);
    rows.push_back(std::move(row));
  }
  return rows;
}

PointReading saPointOf(const SaRow& row, std::size_t names, double unit, double coverage, DecimalSign sign) {
  PointReading point;
  point.line = row.line;
  point.time = row.time;
  if (names >= 1) point.name = row.cells[names - 1];
  if (names >= 2) point.group = row.cells[names - 2];
  if (names >= 3) point.collection = row.cells[0];
  const auto number = [&](std::size_t at) { return decimalOrNan(row.cells[at], sign); };
  for (std::size_t k = 0; k < 3; ++k) point.point[static_cast<Eigen::Index>(k)] = number(names + k) * unit;
  if (row.cells.size() - names - 3 < 3) return point;
  Eigen::Vector3d sigma;
  for (std::size_t k = 0; k < 3; ++k) sigma[static_cast<Eigen::Index>(k)] = number(names + 3 + k) * unit / coverage;
  // Of constructed points the columns are there and hold nothing.
  if (!sigma.isZero(0.0)) point.sigma = sigma;
  return point;
}

}  // namespace

SaLikeness looksLikeSpatialAnalyzer(const FileText& text) {
  // By the first rows: what is wrong further down is wrong in this format.
  constexpr std::size_t kLook = 20;
  std::vector<TextLine> first = rowLines(text, kLook);
  if (first.empty()) return SaLikeness::none;
  const std::string_view start = trimmed(text.text.substr(0, text.text.find_first_of("\r\n")));
  if (start.starts_with(kComment)) return SaLikeness::certain;
  if (first.size() > 1 && !first.back().ended) first.pop_back();
  const std::vector<SaRow> rows = saRowsOf(first, separatorOf(text, first));
  const std::vector<std::size_t> possible = possibleNames(rows, text.decimalSign()).counts;
  if (possible.empty() || first.front().text.find(';') != std::string_view::npos) return SaLikeness::none;
  const bool spaced = std::all_of(first.begin(), first.end(), [](const TextLine& line) {
    return line.text.find(",  ") != std::string_view::npos || line.text.find("   ") != std::string_view::npos;
  });
  const bool named = possible.front() > 0 || rows.front().time;
  return spaced && named ? SaLikeness::certain : SaLikeness::possible;
}

PointFile readSpatialAnalyzer(const FileText& text) {
  PointFile points;
  points.format = PointFormat::sa;
  const SaHeader header = headerOf(text);
  points.frame = header.frame;
  const std::vector<TextLine> lines = rowLines(text);
  if (lines.empty()) throw io::InputError({text.file, 0, ""}, "", "expected points; there are none");
  const std::vector<SaRow> rows = saRowsOf(lines, separatorOf(text, lines));
  const std::size_t names = namesOf(text, rows, header);
  requireWhole(text, rows, lines);
  const double unit = saUnitOf(text, header, points.warnings);
  const std::size_t most =
      std::max_element(rows.begin(), rows.end(),
                       [](const SaRow& a, const SaRow& b) { return a.cells.size() < b.cells.size(); })
          ->cells.size() -
      names - 3;
  if (most == 2)
    points.warnings.push_back(io::inputMessage({text.file, rows.front().line, ""}, "",
                                               "two numbers behind x y z are taken for target offsets and not read"));
  if (most >= 3 && header.coverage == 0.0)
    points.warnings.push_back(
        io::inputMessage({text.file, 0, ""}, "", "the uncertainties' coverage is not stated: taken as one sigma"));
  const auto lone = std::find_if(rows.begin(), rows.end(), [](const SaRow& row) { return row.lone_time; });
  if (lone != rows.end())
    points.warnings.push_back(
        io::inputMessage({text.file, lone->line, ""}, "", "a time without its date is not read: its day is not known"));
  if (!lines.back().ended)
    points.warnings.push_back(io::inputMessage({text.file, lines.back().number, ""}, "",
                                               "the last line has no line end; its last cell may have been cut short"));
  for (const SaRow& row : rows)
    points.points.push_back(
        saPointOf(row, names, unit, header.coverage == 0.0 ? 1.0 : header.coverage, text.decimalSign()));
  return points;
}

}  // namespace stiffscope::interchange
