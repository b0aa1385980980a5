#include "core/interchange/column_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/io/csv.h"
#include "core/io/input_error.h"
#include "core/io/units.h"

namespace stiffscope::interchange {

namespace {

struct ColumnUnit {
  const char* suffix;
  double si_per_unit;
};

constexpr std::array kLengthUnits{ColumnUnit{"_mm", 1e-3}, ColumnUnit{"_m", 1.0}, ColumnUnit{"_um", 1e-6},
                                  ColumnUnit{"_in", 0.0254}};
constexpr std::array kAngleUnits{ColumnUnit{"_deg", io::kDegree}, ColumnUnit{"_rad", 1.0}};
constexpr std::array kTimeUnits{ColumnUnit{"_s", 1.0}, ColumnUnit{"_ms", 1e-3}};
constexpr std::array kForceUnits{ColumnUnit{"_n", 1.0}, ColumnUnit{"_kn", 1e3}};
constexpr std::array kMomentUnits{ColumnUnit{"_nm", 1.0}};
constexpr std::array kTemperatureUnits{ColumnUnit{"_c", 1.0}};

/// Names of columns of text.
const std::set<std::string>& textColumns() {
  static const std::set<std::string> names{"target", "group",  "collection", "name",  "time", "pose",
                                           "step",   "repeat", "axis",       "index", "nest"};
  return names;
}

struct Quantity {
  std::string name;
  double si_per_unit = 1.0;
};

/// All names of columns of numbers, with what they hold.
const std::map<std::string, Quantity>& numberColumns() {
  static const std::map<std::string, Quantity> all = [] {
    std::map<std::string, Quantity> columns;
    const auto add = [&](const std::string& quantity, const auto& units) {
      for (const ColumnUnit& unit : units) columns[quantity + unit.suffix] = {quantity, unit.si_per_unit};
    };
    for (const char* axis : {"x", "y", "z"}) {
      add(axis, kLengthUnits);
      add(std::string("u") + axis, kLengthUnits);
      add(std::string("f") + axis, kForceUnits);
      add(std::string("m") + axis, kMomentUnits);
      add(std::string("p") + axis, kLengthUnits);
    }
    for (const char* turn : {"pw", "pp", "pr"}) add(turn, kAngleUnits);
    for (const char kind : {'q', 'c', 'm'}) {
      for (int joint = 0; joint < kMostJoints; ++joint) add({kind, static_cast<char>('1' + joint)}, kAngleUnits);
    }
    add("time", kTimeUnits);
    add("temperature", kTemperatureUnits);
    return columns;
  }();
  return all;
}

std::vector<std::string> knownColumns() {
  std::vector<std::string> known(textColumns().begin(), textColumns().end());
  for (const auto& [name, quantity] : numberColumns()) known.push_back(name);
  return known;
}

bool isKnownColumn(const std::string& name) { return textColumns().contains(name) || numberColumns().contains(name); }

std::vector<std::string> wordsBetweenBlanks(std::string_view text) {
  std::vector<std::string> words;
  for (const std::string_view word : cellsBetweenBlanks(text, 1)) words.emplace_back(word);
  return words;
}

constexpr char kBlanks = ' ';

/// The separator the user named, or the one that most lines have as often as the columns need.
char separatorOf(const FileText& text, const std::vector<TextLine>& lines, std::size_t columns) {
  const std::string& named = text.options.separator;
  if (named == "tab") return '\t';
  if (named == "blank") return kBlanks;
  if (named.size() == 1) return named[0];
  if (!named.empty()) throw io::InputError({"separator"}, named, "expected one character, tab or blank");
  // A torn row among the first must not choose another separator.
  char best = ',';
  std::ptrdiff_t most = 0;
  for (const char one : {';', '\t', ',', kBlanks}) {
    if (one == ',' && text.options.decimal_comma) continue;
    const auto count = [one](const TextLine& line) {
      return one == kBlanks ? cellsBetweenBlanks(line.text, 1).size() : cellsBetween(line.text, one).size();
    };
    const auto fitting = std::count_if(lines.begin(), lines.end(), [&](const TextLine& line) {
      return columns == 0 ? count(line) > 1 : count(line) >= columns && (one != kBlanks || count(line) == columns);
    });
    if (fitting > most) {
      best = one;
      most = fitting;
    }
  }
  return best;
}

}  // namespace

ColumnTable::ColumnTable(const FileText& text) : text_(text) {
  constexpr std::size_t kLook = 20;
  std::vector<TextLine> first;
  for (const TextLine& line : linesOf(text.text)) {
    if (line.number > text.options.skip && !trimmed(line.text).empty()) first.push_back(line);
    if (first.size() == kLook) break;
  }
  if (first.empty()) throw io::InputError({text.file, 0, ""}, "", "expected rows; there are none");
  if (!text.options.columns.empty()) {
    const std::vector<std::string> names = wordsBetweenBlanks(text.options.columns);
    separator_ = separatorOf(text, first, names.size());
    setColumns(names, 0);
  } else {
    separator_ = separatorOf(text, {first.front()}, 0);
    std::vector<std::string> names;
    for (const std::string_view cell : cellsOf(first.front().text)) {
      const bool known = isKnownColumn(std::string(cell));
      names.push_back(known ? std::string(cell) : "-");
      if (!known && !cell.empty()) unread_.emplace_back(cell);
    }
    setColumns(names, first.front().number);
    header_ = first.front().number;
    if (first.size() == 1)
      throw io::InputError({text.file, 0, ""}, "", "expected rows below the header; there are none");
  }
}

void ColumnTable::forEachRow(const std::function<void(const Row&)>& use) const {
  for (const TextLine& line : linesOf(text_.text)) {
    if (line.number <= std::max(text_.options.skip, header_) || trimmed(line.text).empty()) continue;
    use(rowOf(line));
  }
}

std::size_t ColumnTable::mostRows() const {
  // A cell and what parts it from the next are a byte each at least.
  const std::size_t fit = text_.text.size() / std::max<std::size_t>(1, 2 * columns_ - 1) + 1;
  return std::min(fit, io::linesIn(text_.text));
}

std::vector<std::string_view> ColumnTable::cellsOf(std::string_view line) const {
  return separator_ == kBlanks ? cellsBetweenBlanks(line, 1) : cellsBetween(line, separator_);
}

void ColumnTable::setColumns(const std::vector<std::string>& names, std::size_t line) {
  columns_ = names.size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& name = names[i];
    if (name == "-") continue;
    if (!isKnownColumn(name))
      throw io::InputError(
          {text_.file, line, "columns"}, name,
          "expected a column of the campaign's tables with its unit, time, or - for one that is not read" +
              io::nearestNameHint(name, knownColumns()));
    const auto number = numberColumns().find(name);
    const std::string quantity = number == numberColumns().end() ? name : number->second.name;
    if (numbers_.contains(quantity) || places_.contains(name))
      throw io::InputError({text_.file, line, "columns"}, name, "expected this column once");
    if (number == numberColumns().end()) {
      places_[name] = i;
    } else {
      numbers_[quantity] = {i, number->second.si_per_unit, name};
    }
  }
}

ColumnTable::Row ColumnTable::rowOf(const TextLine& line) const {
  Row row{cellsOf(line.text), line.number};
  while (row.cells.size() > columns_ && row.cells.back().empty()) row.cells.pop_back();
  if (row.cells.size() != columns_) {
    const char* const why = !line.ended ? "; the file ends in the middle of this line"
                            : row.cells.size() > columns_ && separator_ == ','
                                ? "; a decimal comma splits a number in two"
                                : "";
    throw io::InputError({text_.file, line.number, ""}, fmt::format("{} cells", row.cells.size()),
                         fmt::format("expected {} cells, one a column{}", columns_, why));
  }
  return row;
}

Vector6d ColumnTable::wrench(const Row& row) const {
  // One after the other: a comma initializer that an exception leaves unfinished is an error of its own to Eigen.
  constexpr std::array<const char*, 6> kNames{"fx", "fy", "fz", "mx", "my", "mz"};
  Vector6d wrench;
  for (std::size_t i = 0; i < kNames.size(); ++i) wrench[static_cast<Eigen::Index>(i)] = number(row, kNames[i]);
  return wrench;
}

double ColumnTable::number(const Row& row, const std::string& quantity) const {
  const NumberColumn& column = numbers_.at(quantity);
  return decimal(row.cells[column.place], text_.decimalSign(), text_.file, row.line, column.name) * column.si_per_unit;
}

double ColumnTable::numberOrBlank(const Row& row, const std::string& quantity) const {
  return row.cells[numbers_.at(quantity).place].empty() ? campaign::kNotGiven : number(row, quantity);
}

bool ColumnTable::hasNumbers(const std::vector<std::string>& quantities) const {
  return std::all_of(quantities.begin(), quantities.end(), [&](const std::string& one) { return hasNumber(one); });
}

bool ColumnTable::hasAllOrNone(const std::vector<std::string>& quantities) const {
  const auto missing =
      std::find_if(quantities.begin(), quantities.end(), [&](const std::string& one) { return !hasNumber(one); });
  if (missing == quantities.end()) return true;
  const bool none =
      std::none_of(quantities.begin(), quantities.end(), [&](const std::string& one) { return hasNumber(one); });
  if (!none)
    throw io::InputError({text_.file, 0, "columns"}, *missing,
                         fmt::format("expected {} all or none, each with its unit", fmt::join(quantities, ", ")));
  return false;
}

std::vector<std::string> ColumnTable::warnings() const {
  if (unread_.empty()) return {};
  return {io::inputMessage({text_.file, text_.options.skip + 1, ""}, "",
                           fmt::format("columns that are not read: {}", fmt::join(unread_, ", ")))};
}

std::string ColumnTable::text(const Row& row, const std::string& column) const {
  const auto place = places_.find(column);
  if (place == places_.end()) return {};
  const std::string_view cell = row.cells[place->second];
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::any_of(cell.begin(), cell.end(), is_control))
    throw io::InputError({text_.file, row.line, column}, std::string(cell),
                         "expected text without control characters, which no table can hold");
  return std::string(cell);
}

std::optional<Timestamp> ColumnTable::time(const Row& row) const {
  if (const auto seconds = numbers_.find("time"); seconds != numbers_.end()) {
    const std::string_view cell = row.cells[seconds->second.place];
    if (cell.empty()) return std::nullopt;
    const int decimals = std::max(0, decimalsOf(cell));
    return Timestamp{number(row, "time"), false, std::pow(10.0, -decimals) * seconds->second.si_per_unit};
  }
  const std::string cell = text(row, "time");
  if (cell.empty()) return std::nullopt;
  const auto time = parseTimestamp(cell);
  if (time) return time;
  const bool rounded = cell.find_first_of("eE") != std::string::npos && cell.find_first_of("0123456789") == 0;
  throw io::InputError({text_.file, row.line, "time"}, cell,
                       rounded
                           ? "expected a date and a time; a spreadsheet rounded this one, leave the column out with -"
                           : "expected a date and a time");
}

bool hasColumnHeader(const FileText& text) {
  if (!text.options.columns.empty()) return true;
  for (const TextLine& line : linesOf(text.text)) {
    if (line.number <= text.options.skip || trimmed(line.text).empty()) continue;
    for (const char separator : {';', '\t', ',', kBlanks}) {
      const auto cells = separator == kBlanks ? cellsBetweenBlanks(line.text, 1) : cellsBetween(line.text, separator);
      const auto known = std::count_if(cells.begin(), cells.end(),
                                       [](std::string_view cell) { return isKnownColumn(std::string(cell)); });
      if (known >= 3) return true;
    }
    return false;
  }
  return false;
}

PointFile readPointColumns(const FileText& text) {
  if (!hasColumnHeader(text))
    throw io::InputError({text.file, text.options.skip + 1, "columns"}, "",
                         "expected the names of its columns (option columns), or a header line that has them");
  const ColumnTable table(text);
  if (!table.hasNumbers({"x", "y", "z"}))
    throw io::InputError({text.file, 0, "columns"}, text.options.columns,
                         "expected x, y and z with their unit, as x_mm y_mm z_mm");
  const bool sigmas = table.hasAllOrNone({"ux", "uy", "uz"});
  PointFile points;
  points.format = PointFormat::columns;
  points.warnings = table.warnings();
  constexpr std::array<const char*, 5> kDayColumns{"pose", "step", "repeat", "axis", "index"};
  const bool named =
      std::any_of(kDayColumns.begin(), kDayColumns.end(), [&](const char* column) { return table.has(column); });
  PointGroups groups;
  points.points.reserve(table.mostRows());
  table.forEachRow([&](const ColumnTable::Row& row) {
    PointReading point;
    point.line = row.line;
    point.of = groups.of(table.text(row, "collection"), table.text(row, "group"));
    point.name = table.has("target") ? table.text(row, "target") : table.text(row, table.has("nest") ? "nest" : "name");
    point.point = {table.number(row, "x"), table.number(row, "y"), table.number(row, "z")};
    if (sigmas) {
      const Eigen::Vector3d sigma(table.number(row, "ux"), table.number(row, "uy"), table.number(row, "uz"));
      if (sigma.minCoeff() < 0.0)
        throw io::InputError({text.file, row.line, "ux uy uz"}, fmt::format("{:g}", sigma.minCoeff()),
                             "expected standard uncertainties, not below zero");
      if (!sigma.isZero(0.0)) point.sigma = sigma;
    }
    point.time = table.time(row);
    if (named) {
      PointReading::Columns columns;
      for (const char* column : kDayColumns) {
        if (table.has(column)) columns[column] = table.text(row, column);
      }
      point.columns = std::make_shared<const PointReading::Columns>(std::move(columns));
    }
    points.points.push_back(std::move(point));
  });
  return points;
}

}  // namespace stiffscope::interchange
