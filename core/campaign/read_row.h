#pragma once

#include <cmath>
#include <variant>
#include <vector>

#include "core/campaign/table_layout.h"
#include "core/campaign/table_lines.h"
#include "core/input/eight_digits.h"

namespace stiffscope {

template <class Row>
std::vector<WantedColumn> wantedColumns(const TableLayout<Row>& layout) {
  std::vector<WantedColumn> wanted;
  for (const Column<Row>& column : layout.columns) wanted.push_back({column.name, column.required});
  return wanted;
}

/// Reads the lines of a table into rows, in SI and radians. What its columns are is settled once for all lines, of which
/// there may be millions.
template <class Row>
class RowReader {
 public:
  /// `lines`: of that table. The file's name and the layout must outlive this object.
  RowReader(const std::string& file, const TableLayout<Row>& layout, const TableLines& lines) : file_(file) {
    for (std::size_t i = 0; i < layout.columns.size(); ++i) {
      const Column<Row>& column = layout.columns[i];
      if (!lines.has(i)) continue;
      Present present{&column, lines.placeOf(i), nullptr, {}};
      if (const auto* number = std::get_if<typename Column<Row>::Number>(&column.member)) {
        present.number = *number;
        present.written = numberKind(column.kind);
      }
      columns_.push_back(present);
    }
  }

  /// The cells of the line that `lines` gave last, and its number. Throws InputError for a cell that its column cannot hold.
  void read(const TableLines& lines, CampaignNames& names, Row& row) const {
    row.line = lines.line();
    const bool room = lines.hasRoomBehindCells();
    for (const Present& present : columns_) {
      const std::string_view cell = lines.cellAt(present.place);
      if (present.number != nullptr && room) {
        const double value = parseEightAtOnce(cell);
        if (std::abs(value) <= present.written.limit) {  // not where it is NaN
          present.number(row) = value * present.written.si_per_unit;
          continue;
        }
      }
      readAny(*present.column, cell, {file_, row.line, present.column->name}, names, row);
    }
  }

 private:
  /// A column that the table has.
  struct Present {
    const Column<Row>* column;
    std::size_t place;                    ///< in the table
    typename Column<Row>::Number number;  ///< its member of a row; nullptr where it is no number
    NumberKind written;                   ///< of a number
  };

  static void readAny(const Column<Row>& column, std::string_view cell, const CellPlace& place, CampaignNames& names,
                      Row& row) {
    if (const auto* number = std::get_if<typename Column<Row>::Number>(&column.member)) {
      (*number)(row) = readNumberCell(column.kind, cell, place);
    } else if (const auto* index = std::get_if<typename Column<Row>::Index>(&column.member)) {
      (*index)(row) = readIndexCell(column.kind, cell, place, names);
    } else {
      std::get<typename Column<Row>::Text>(column.member)(row) = readTextCell(cell, place);
    }
  }

  const std::string& file_;
  std::vector<Present> columns_;
};

}  // namespace stiffscope
