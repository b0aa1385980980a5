#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/campaign/table_header.h"
#include "core/input/csv_lines.h"

namespace stiffscope {

/// A table's bytes and its name for messages.
struct TableSource {
  std::string file;
  std::string_view bytes;
};

/// The data lines of a table: reads the header and hands out line after line, each with as many cells as the
/// header has. Throws InputError where a line has more or fewer, where there is no header or no data line, where the header
/// has more than a thousand columns, and where something stands in a column without a name (columns without a name are
/// what a spreadsheet leaves behind the last one).
/// A last line without a line end, but with all its cells, gives a warning: its last number may be cut short.
class TableLines {
 public:
  TableLines(const TableSource& source, const std::vector<WantedColumn>& wanted,
             std::vector<std::string>& warnings);

  /// A part of the lines behind `table`'s header, `lines_before` of the file before it: read as the whole is, but one
  /// without a row is no error. Only the last part can have a last line without a line end, so that no two of them
  /// read in different threads give a warning.
  TableLines(const TableLines& table, std::string_view part, std::size_t lines_before);

  bool next();

  /// What stands behind the line last given.
  std::string_view rest() const { return lines_.rest(); }

  /// As many rows as there can be in `lines` lines of so many bytes; a guess where an optional column is absent.
  std::size_t mostRows(std::size_t bytes, std::size_t lines) const;

  std::size_t line() const { return lines_.line(); }
  bool has(std::size_t column) const { return placeOf(column) != kAbsentColumn; }

  /// Where the column that is the `column`-th of those wanted stands in the table; kAbsentColumn where it does not.
  std::size_t placeOf(std::size_t column) const { return places_[column]; }

  /// Cell of the current line in the `place`-th column of the table.
  std::string_view cellAt(std::size_t place) const { return cells_[place]; }

  /// Cell of the current line in the column that is the `column`-th of those wanted.
  std::string_view cell(std::size_t column) const { return cellAt(placeOf(column)); }
  bool hasRoomBehindCells() const { return lines_.hasRoomBehindCells(); }

 private:
  void requireCellCount() const;
  void requireNothingWithoutName() const;

  const TableSource& source_;
  CsvLines lines_;
  std::vector<std::string_view> cells_;
  std::vector<std::size_t> places_, nameless_;
  std::size_t cells_in_header_ = 0;
  std::size_t rows_ = 0;
  bool row_required_ = true;
  std::vector<std::string>& warnings_;
};

}  // namespace stiffscope
