#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/interchange/point_formats.h"

namespace stiffscope::interchange {

/// A table of a program of one's own: rows of cells, and what each column holds. Names of columns are those of the
/// campaign's tables with a unit at their end (x_mm, q1_deg, fx_n), `time` of a date with a time, and `-` of what is
/// not read. They come from the user (FileOptions::columns), or from the file's header line where that has them.
class ColumnTable {
 public:
  struct Row {
    std::vector<std::string_view> cells;
    std::size_t line = 0;
  };

  /// Throws InputError where a name is none or stands twice; forEachRow where a row has more or fewer cells than there
  /// are columns (cells behind the last column that are empty are none).
  explicit ColumnTable(const FileText& text);

  /// Rows are made one after the other: of 100 MB they would be half a gigabyte.
  void forEachRow(const std::function<void(const Row&)>& use) const;
  /// As many as there can be.
  std::size_t mostRows() const;

  bool has(const std::string& column) const { return places_.contains(column); }

  /// A number in SI, by the column's name without its unit (x, q1, fx, time). Throws InputError where it is none.
  double number(const Row& row, const std::string& quantity) const;
  /// The same of a table that may leave the cell blank: not a number then.
  double numberOrBlank(const Row& row, const std::string& quantity) const;
  /// fx, fy, fz, mx, my, mz, of a table that has them.
  Vector6d wrench(const Row& row) const;
  bool hasNumber(const std::string& quantity) const { return numbers_.contains(quantity); }
  /// Whether its column has this name, with the unit.
  bool isNamed(const std::string& quantity, const std::string& column) const {
    const auto found = numbers_.find(quantity);
    return found != numbers_.end() && found->second.name == column;
  }
  bool hasNumbers(const std::vector<std::string>& quantities) const;
  /// Whether the table has them. Throws InputError where it has some of them only.
  bool hasAllOrNone(const std::vector<std::string>& quantities) const;

  /// What the header line names and is not read.
  std::vector<std::string> warnings() const;

  /// The cell of a column of names; empty where there is no such column.
  std::string text(const Row& row, const std::string& column) const;

  /// `time` or `time_s`, `time_ms`; nullopt where the table has neither, or the cell is empty.
  std::optional<Timestamp> time(const Row& row) const;

  /// How the columns are kept apart: a character, or ' ' for runs of blanks.
  char separator() const { return separator_; }

 private:
  struct NumberColumn {
    std::size_t place = 0;
    double si_per_unit = 1.0;
    std::string name;
  };

  void setColumns(const std::vector<std::string>& names, std::size_t line);
  Row rowOf(const TextLine& line) const;
  std::vector<std::string_view> cellsOf(std::string_view line) const;

  const FileText text_;
  char separator_ = ',';
  std::size_t columns_ = 0;
  std::map<std::string, std::size_t> places_;    ///< of columns of names, and all by their full name
  std::map<std::string, NumberColumn> numbers_;  ///< by the name without its unit
  std::size_t header_ = 0;                       ///< line of the header; 0: the user named the columns
  std::vector<std::string> unread_;
};

}  // namespace stiffscope::interchange
