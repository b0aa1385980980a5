#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/csv.h"

namespace stiffscope::campaign {

/// A column as the header line is matched against it.
struct WantedColumn {
  std::string name;
  bool required = true;
  std::string together = {};  ///< optional columns of one such name are there all or none
};

inline constexpr std::size_t kAbsentColumn = static_cast<std::size_t>(-1);

/// For each wanted column its place among `cells`, the header line's, or kAbsentColumn where an optional one
/// is absent. Columns that nobody wants go into one warning that names them all. Throws InputError, naming
/// `file` and `line`, for a required column that is missing, one that is there twice, and a file whose
/// columns are not separated by commas.
std::vector<std::size_t> matchHeader(const std::string& file, std::size_t line,
                                     const std::vector<std::string_view>& cells,
                                     const std::vector<WantedColumn>& wanted, std::vector<std::string>& warnings);

/// A table's bytes and its name for messages.
struct TableSource {
  std::string file;
  std::string_view bytes;
};

/// The data lines of a table: reads the header and hands out line after line, each with as many cells as the
/// header has. Throws InputError where a line has more or fewer, where there is no header or no data line, where the
/// header has more than a thousand columns, and where something stands in a column without a name (columns without a
/// name are what a spreadsheet leaves behind the last one). A last line without a line end, but with all its cells,
/// gives a warning: its last number may be cut short.
class TableLines {
 public:
  TableLines(const TableSource& source, const std::vector<WantedColumn>& wanted, std::vector<std::string>& warnings);

  /// A part of the lines behind `table`'s header, `lines_before` of the file before it: read as the whole is, but one
  /// without a row is no error. Only the last part can have a last line without a line end, so that no two of them
  /// read in different threads give a warning.
  TableLines(const TableLines& table, std::string_view part, std::size_t lines_before);

  bool next();

  /// What stands behind the line last given.
  std::string_view rest() const { return lines_.rest(); }

  /// As many rows as there can be in `lines` lines of so many bytes.
  std::size_t mostRows(std::size_t bytes, std::size_t lines) const;

  std::size_t line() const { return lines_.line(); }
  bool has(std::size_t column) const { return placeOf(column) != kAbsentColumn; }

  /// Where the column that is the `column`-th of those wanted stands in the table; kAbsentColumn where it does not.
  std::size_t placeOf(std::size_t column) const { return places_[column]; }

  /// Cell of the current line in the `place`-th column of the table.
  std::string_view cellAt(std::size_t place) const { return cells_[place]; }

  /// Cell of the current line in the column that is the `column`-th of those wanted.
  std::string_view cell(std::size_t column) const { return cellAt(placeOf(column)); }

 private:
  void requireCellCount() const;
  void requireNothingWithoutName() const;

  const TableSource& source_;
  io::CsvLines lines_;
  std::vector<std::string_view> cells_;
  std::vector<std::size_t> places_, nameless_;
  std::size_t cells_in_header_ = 0;
  std::size_t shortest_row_ = 0;  ///< bytes, its line end among them
  std::size_t rows_ = 0;
  bool row_required_ = true;
  std::vector<std::string>& warnings_;
};

}  // namespace stiffscope::campaign
