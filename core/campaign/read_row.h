#pragma once

#include <cmath>
#include <cstddef>
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
      Present present{&column, lines.placeOf(i), Quick::none, 0, {}};
      if (const auto* number = std::get_if<typename Column<Row>::Number>(&column.member)) {
        present.quick = Quick::number;
        present.offset = offsetOf(*number);
        present.written = numberKind(column.kind);
      } else if (column.kind == CellKind::step) {
        present.quick = Quick::whole;
        present.offset = offsetOf(std::get<typename Column<Row>::Index>(column.member));
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
      if (present.quick == Quick::number && room) {
        const double value = parseEightAtOnce(cell);
        if (std::abs(value) <= present.written.limit) {  // not where it is NaN
          memberAt<double>(present, row) = value * present.written.si_per_unit;
          continue;
        }
      } else if (present.quick == Quick::whole && room) {
        const int value = wholeEightAtOnce(cell);
        if (value >= 0) {
          memberAt<int>(present, row) = value;
          continue;
        }
      }
      readAny(*present.column, cell, {file_, row.line, present.column->name}, names, row);
    }
  }

 private:
  /// What most cells of a column hold, which is read without a call.
  enum class Quick { none, number, whole };

  /// A column that the table has.
  struct Present {
    const Column<Row>* column;
    std::size_t place;      ///< in the table
    Quick quick;
    std::ptrdiff_t offset;  ///< of its member in a row, bytes; of those read quickly
    NumberKind written;     ///< of a number
  };

  /// Where in a row a column's member stands.
  template <class Member>
  static std::ptrdiff_t offsetOf(Member& (*member)(Row&)) {
    Row row;
    return reinterpret_cast<std::byte*>(&member(row)) - reinterpret_cast<std::byte*>(&row);
  }

  template <class Member>
  static Member& memberAt(const Present& present, Row& row) {
    return *reinterpret_cast<Member*>(reinterpret_cast<std::byte*>(&row) + present.offset);
  }

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
