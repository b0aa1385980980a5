#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "core/interchange/export_comments.h"
#include "core/interchange/point_formats.h"
#include "core/interchange/spatial_analyzer_row.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"

namespace stiffscope::interchange {

namespace {

/// Calls use(line) for every line that is a row, until `use` returns false where it returns something.
template <class Use>
void forEachRowLine(const FileText& text, const Use& use) {
  for (const TextLine& line : linesOf(text.text)) {
    const std::string_view content = trimmed(line.text);
    if (line.number <= text.options.skip || content.empty() || content.starts_with(kExportComment)) continue;
    if constexpr (std::is_same_v<std::invoke_result_t<Use, const TextLine&>, bool>) {
      if (!use({content, line.number, line.ended})) return;
    } else {
      use({content, line.number, line.ended});
    }
  }
}

std::vector<TextLine> rowLines(const FileText& text, std::size_t most) {
  std::vector<TextLine> rows;
  forEachRowLine(text, [&](const TextLine& line) {
    rows.push_back(line);
    return rows.size() < most;
  });
  return rows;
}

/// What of the separators all rows have.
class SaSeparators {
 public:
  void add(const TextLine& row) {
    constexpr std::size_t kApart = 2;
    comma_ = comma_ && row.text.find(',') != std::string_view::npos;
    wide_ = wide_ && (longestBlanks(row.text) >= kApart || row.text.find('\t') != std::string_view::npos);
    if (comma_ && decimal_) {
      // "Main   1   2296,337   -2416,231": every comma is inside a number.
      const auto cells = cellsBetweenBlanks(row.text, 1);
      decimal_ = std::none_of(cells.begin(), cells.end(), [](std::string_view cell) { return cell.ends_with(','); }) &&
                 std::any_of(cells.begin(), cells.end(), looksLikeDecimalComma);
    }
    if (first_.number == 0) first_ = row;
  }

  /// Throws InputError where numbers have decimal commas that nobody spoke of.
  SaSeparator chosen(const FileText& text) const {
    const std::size_t blanks = wide_ ? 2 : 1;
    if (text.options.decimal_comma) return {false, blanks};
    if (comma_ && decimal_)
      throw io::InputError({text.file, first_.number, ""}, std::string(first_.text),
                           "expected decimal points; these numbers have commas (option decimal-comma)");
    return {comma_, blanks};
  }

 private:
  TextLine first_;
  bool comma_ = true, wide_ = true, decimal_ = true;
};

SaSeparator separatorOf(const FileText& text, const std::vector<TextLine>& rows) {
  SaSeparators separators;
  for (const TextLine& row : rows) separators.add(row);
  return separators.chosen(text);
}

SaSeparator separatorOf(const FileText& text) {
  SaSeparators separators;
  forEachRowLine(text, [&](const TextLine& row) { separators.add(row); });
  return separators.chosen(text);
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
bool areUncertainties(const std::vector<std::string_view>& cells, std::size_t from, std::size_t count,
                      DecimalSign sign) {
  if (from + count > cells.size()) return false;
  double squares = 0.0;
  for (std::size_t i = from; i < from + 3; ++i) {
    const double value = decimalOrNan(cells[i], sign);
    if (!(value >= 0.0)) return false;
    squares += value * value;
  }
  if (count < 4) return true;
  const double whole = decimalOrNan(cells[from + 3], sign);
  const int decimals = decimalsOf(cells[from + 3]);
  const double rounding = decimals < 0 ? 1e-3 * whole : 3.0 * std::pow(10.0, -decimals);
  return std::abs(whole - std::sqrt(squares)) <= rounding;
}

constexpr std::size_t kMostNames = 3;

/// How strictly what follows x y z is taken: nothing, two target offsets, or uncertainties; or anything else that the
/// writer may put there (tolerances, weights, comments, details of the measurement), which is not read.
enum class Behind { known, anything };

bool fitsNames(const SaRow& row, std::size_t names, DecimalSign sign, Behind allowed) {
  if (!areCoordinates(row.cells, names, sign)) return false;
  if (allowed == Behind::anything) return true;
  const std::size_t behind = row.cells.size() - names - 3;
  if (behind == 0) return true;
  for (std::size_t i = names + 3; i < row.cells.size(); ++i) {
    if (std::isnan(decimalOrNan(row.cells[i], sign))) return false;
  }
  if (behind == 2) return true;
  return (behind == 3 || behind == 4) && areUncertainties(row.cells, names + 3, behind, sign);
}

/// How many names can stand before the coordinates of all rows, and the first row that none is left for.
class PossibleNames {
 public:
  PossibleNames(DecimalSign sign, Behind allowed) : sign_(sign), allowed_(allowed) {
    for (std::size_t names = 0; names <= kMostNames; ++names) counts.push_back(names);
  }
  void add(const SaRow& row) {
    if (misfit) return;
    std::erase_if(counts, [&](std::size_t names) { return !fitsNames(row, names, sign_, allowed_); });
    if (counts.empty()) misfit = row;
  }

  std::vector<std::size_t> counts;
  std::optional<SaRow> misfit;

 private:
  DecimalSign sign_;
  Behind allowed_;
};

[[noreturn]] void refuseRow(const FileText& text, const SaRow& row) {
  const bool cut = !row.ended;
  for (std::size_t i = 0; i < row.cells.size() && i < kMostNames + 3; ++i) {
    if (text.decimalSign() == DecimalSign::point && looksLikeDecimalComma(row.cells[i]))
      decimal(row.cells[i], DecimalSign::point, text.file, row.line, "");
  }
  throw io::InputError(
      {text.file, row.line, ""}, fmt::format("{}", fmt::join(row.cells, " | ")),
      std::string("expected up to three names, x y z with the same decimals, and behind them cells as in "
                  "the other rows, and a time") +
          (cut ? "; the file ends in the middle of this line" : ""));
}

/// Calls use(row) for every row of the file, one after the other: a file of 100 MB has two million.
template <class Use>
void forEachRow(const FileText& text, const SaSeparator& separator, const Use& use) {
  forEachRowLine(text, [&](const TextLine& line) { use(saRowOf(line, separator)); });
}

/// Where uncertainties stand behind x y z, and how many cells they are; cells that are there and are not read.
struct SaColumns {
  std::size_t names = 0;
  std::optional<std::size_t> uncertainties;  ///< first of them, counted behind x y z
  std::size_t of_them = 0;                   ///< three, or four with their root of squares
  bool offsets = false, others = false;      ///< not read
};

/// What all rows of a file have in common.
class SaSurvey {
 public:
  SaSurvey(const FileText& text, const ExportComments& header)
      : text_(text), header_(header), sign_(text.decimalSign()) {}

  void add(const SaRow& row) {
    known_.add(row);
    any_.add(row);
    if (start_.size() < kStart) start_.push_back(row);
    if (row.cells.size() > most_) most_ = row.cells.size();
    before_last_ = std::move(last_);
    last_ = row;
    if (row.lone_time && lone_time == 0) lone_time = row.line;
    if (!row.unread_time.empty() && unread_time.empty()) {
      unread_time = row.unread_time;
      unread_line = row.line;
    }
    ++rows;
  }

  /// Throws InputError where rows fit no count of names, or several.
  SaColumns columns() const {
    SaColumns columns;
    const bool plain = !known_.misfit;
    if (!plain && any_.misfit) refuseRow(text_, *any_.misfit);
    columns.names = onlyOne(plain ? known_.counts : any_.counts, plain);
    if (!plain) requireOthers(columns.names);
    const std::size_t behind = most_ - columns.names - 3;
    if (!plain) {
      columns.others = true;
    } else if (behind >= 3) {
      columns.uncertainties = 0;
      columns.of_them = behind;
    }
    columns.offsets = plain && behind == 2;
    return columns;
  }

  /// A last number that lacks digits was cut off with the file.
  void requireWhole() const {
    if (rows < 2 || last_.ended || last_.time) return;
    const auto &last = last_.cells, &before = before_last_.cells;
    if (last.empty() || before.empty() || last.size() != before.size()) return;
    if (std::isnan(decimalOrNan(last.back(), sign_)) || decimalsOf(last.back()) >= decimalsOf(before.back())) return;
    throw io::InputError({text_.file, last_.line, ""}, std::string(last.back()),
                         "expected as many decimals as above; the file ends in the middle of this number");
  }

  const SaRow& first() const { return start_.front(); }
  const SaRow& last() const { return last_; }
  std::size_t most() const { return most_; }

  std::size_t rows = 0, lone_time = 0, unread_line = 0;
  std::string unread_time;  ///< of the first row that has one

 private:
  static constexpr std::size_t kStart = 20;

  /// Columns of another kind are there from the start: one row among plain ones is torn.
  void requireOthers(std::size_t names) const {
    const auto plain = std::count_if(start_.begin(), start_.end(),
                                     [&](const SaRow& row) { return fitsNames(row, names, sign_, Behind::known); });
    const bool torn = known_.misfit->line == last_.line && !last_.ended;
    if (torn || 2 * plain > static_cast<std::ptrdiff_t>(start_.size())) refuseRow(text_, *known_.misfit);
  }

  /// Where several counts fit, that by which the columns are as many as the comments say.
  std::size_t onlyOne(std::vector<std::size_t> possible, bool plain) const {
    if (possible.size() > 1 && header_.uncertainties && plain) {
      const std::size_t said = most_ - 3 - static_cast<std::size_t>(*header_.uncertainties);
      if (std::find(possible.begin(), possible.end(), said) != possible.end()) return said;
    }
    if (possible.size() == 1) return possible.front();
    throw io::InputError({text_.file, first().line, ""}, fmt::format("{}", fmt::join(first().cells, " | ")),
                         fmt::format("expected rows that can be read in one way; there may be {} names before x y z: "
                                     "name the columns (format columns)",
                                     fmt::join(possible, " or ")));
  }

  const FileText& text_;
  const ExportComments& header_;
  DecimalSign sign_;
  PossibleNames known_{sign_, Behind::known}, any_{sign_, Behind::anything};
  std::vector<SaRow> start_;
  SaRow last_, before_last_;
  std::size_t most_ = 0;
};

/// Of cells of several kinds behind x y z the four that are uncertainties: numbers whose fourth is the root of the sum
/// of the others' squares, at one place in all rows and not zero in all. Without it none is read.
void findUncertainties(const FileText& text, const SaSeparator& separator, std::size_t most, SaColumns& columns) {
  constexpr std::size_t kCells = 4;
  struct Window {
    std::size_t at = 0;
    bool fits = true, any = false;
  };
  std::vector<Window> windows;
  for (std::size_t at = 0; columns.names + 3 + at + kCells <= most; ++at) windows.push_back({at});
  forEachRow(text, separator, [&](const SaRow& row) {
    for (Window& window : windows) {
      const std::size_t from = columns.names + 3 + window.at;
      if (!window.fits || from + kCells > row.cells.size()) continue;
      window.fits = areUncertainties(row.cells, from, kCells, text.decimalSign());
      window.any = window.any || (window.fits && decimalOrNan(row.cells[from + 3], text.decimalSign()) > 0.0);
    }
  });
  std::erase_if(windows, [](const Window& window) { return !window.fits || !window.any; });
  if (windows.size() != 1) return;
  columns.uncertainties = windows.front().at;
  columns.of_them = kCells;
}

PointReading saPointOf(const SaRow& row, const SaColumns& columns, double unit, const ExportComments& header,
                       DecimalSign sign, PointGroups& groups) {
  const AxisOrder axes = header.axes.value_or(kUsualOrder), uncertainty_axes = header.uncertainty_axes.value_or(axes);
  const double coverage = header.coverage == 0.0 ? 1.0 : header.coverage;
  PointReading point;
  point.line = row.line;
  point.time = row.time;
  const std::size_t names = columns.names;
  if (names >= 1) point.name = row.cells[names - 1];
  if (names >= 2) point.of = groups.of(names >= 3 ? row.cells[0] : std::string_view(), row.cells[names - 2]);
  const auto number = [&](std::size_t at) { return decimalOrNan(row.cells[at], sign); };
  for (std::size_t k = 0; k < 3; ++k) point.point[axes[k]] = number(names + k) * unit;
  if (!columns.uncertainties || row.cells.size() < names + 3 + *columns.uncertainties + 3) return point;
  Eigen::Vector3d sigma;
  for (std::size_t k = 0; k < 3; ++k)
    sigma[uncertainty_axes[k]] = number(names + 3 + *columns.uncertainties + k) * unit / coverage;
  // Of constructed points the columns are there and hold nothing.
  if (!sigma.isZero(0.0)) point.sigma = sigma;
  return point;
}

/// What had to be taken for granted of the columns, one line each.
void warnOfColumns(const FileText& text, const ExportComments& header, const SaSurvey& survey, const SaColumns& columns,
                   std::vector<std::string>& warnings) {
  const auto warn = [&](std::size_t line, const char* why) {
    warnings.push_back(io::inputMessage({text.file, line, ""}, "", why));
  };
  if (columns.offsets) warn(survey.first().line, "two numbers behind x y z are taken for target offsets and not read");
  if (columns.others)
    warn(survey.first().line, columns.uncertainties
                                  ? "cells behind x y z that are no uncertainties are not read"
                                  : "cells behind x y z are not read: among them are no four uncertainties");
  if (columns.of_them == 3 && header.uncertainties.value_or(0) < 3)
    warn(survey.first().line, "three numbers behind x y z are taken for their uncertainties");
  if (columns.uncertainties && header.coverage == 0.0)
    warn(0, "the uncertainties' coverage is not stated: taken as one sigma");
  if (survey.lone_time > 0) warn(survey.lone_time, "a time without its date is not read: its day is not known");
  if (!survey.unread_time.empty())
    warnings.push_back(io::inputMessage({text.file, survey.unread_line, "time"}, survey.unread_time,
                                        "no time that can be read, so that these rows have none: dates with slashes "
                                        "have the month first, those with points the day"));
  if (!survey.last().ended)
    warn(survey.last().line, "the last line has no line end; its last cell may have been cut short");
}

}  // namespace

SaLikeness looksLikeSpatialAnalyzer(const FileText& text) {
  // By the first rows: what is wrong further down is wrong in this format.
  constexpr std::size_t kLook = 20;
  std::vector<TextLine> first = rowLines(text, kLook);
  if (first.empty()) return SaLikeness::none;
  const std::string_view start = trimmed(text.text.substr(0, text.text.find_first_of("\r\n")));
  if (start.starts_with(kExportComment)) return SaLikeness::certain;
  if (first.size() > 1 && !first.back().ended) first.pop_back();
  const SaSeparator separator = separatorOf(text, first);
  PossibleNames known(text.decimalSign(), Behind::known), any(text.decimalSign(), Behind::anything);
  bool timed = false;
  for (const TextLine& line : first) {
    const SaRow row = saRowOf(line, separator);
    known.add(row);
    any.add(row);
    timed = timed || row.time;
  }
  const std::vector<std::size_t>& possible = known.misfit ? any.counts : known.counts;
  if (possible.empty() || first.front().text.find(';') != std::string_view::npos) return SaLikeness::none;
  const bool spaced = std::all_of(first.begin(), first.end(), [](const TextLine& line) {
    return line.text.find(",  ") != std::string_view::npos || line.text.find("   ") != std::string_view::npos;
  });
  const bool named = possible.front() > 0 || timed;
  // Cells that no rule explains are SpatialAnalyzer's only where the writer's own spacing says so.
  if (known.misfit && !(spaced && named)) return SaLikeness::none;
  return spaced && named ? SaLikeness::certain : SaLikeness::possible;
}

PointFile readSpatialAnalyzer(const FileText& text) {
  PointFile points;
  points.format = PointFormat::sa;
  const ExportComments header = exportCommentsOf(text);
  points.frame = header.frame;
  const SaSeparator separator = separatorOf(text);
  SaSurvey survey(text, header);
  forEachRow(text, separator, [&](const SaRow& row) { survey.add(row); });
  if (survey.rows == 0) throw io::InputError({text.file, 0, ""}, "", "expected points; there are none");
  SaColumns columns = survey.columns();
  if (columns.others) findUncertainties(text, separator, survey.most(), columns);
  survey.requireWhole();
  const double unit = statedUnitOf(text, header, points.warnings);
  if (!header.uncertainties)
    points.warnings.push_back(
        io::inputMessage({text.file, 0, ""}, "", "no comment names the axes: Cartesian x y z are taken"));
  warnOfColumns(text, header, survey, columns, points.warnings);
  points.points.reserve(survey.rows);
  PointGroups groups;
  forEachRow(text, separator, [&](const SaRow& row) {
    points.points.push_back(saPointOf(row, columns, unit, header, text.decimalSign(), groups));
  });
  return points;
}

}  // namespace stiffscope::interchange
