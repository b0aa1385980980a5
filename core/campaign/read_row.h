#pragma once

#include <variant>

#include "core/campaign/table_layout.h"
#include "core/campaign/table_lines.h"

namespace stiffscope {

template <class Row>
std::vector<WantedColumn> wantedColumns(const TableLayout<Row>& layout) {
  std::vector<WantedColumn> wanted;
  for (const Column<Row>& column : layout.columns) wanted.push_back({column.name, column.required});
  return wanted;
}

/// Puts one cell into its member of the row, in SI and radians.
template <class Row>
void readCell(const Column<Row>& column, std::string_view cell, const CellPlace& place, bool room_behind,
              CampaignNames& names, Row& row) {
  if (const auto* number = std::get_if<typename Column<Row>::Number>(&column.member)) {
    (*number)(row) = readNumberCell(column.kind, cell, place, room_behind);
  } else if (const auto* index = std::get_if<typename Column<Row>::Index>(&column.member)) {
    (*index)(row) = readIndexCell(column.kind, cell, place, names);
  } else {
    std::get<typename Column<Row>::Text>(column.member)(row) = readTextCell(cell, place);
  }
}

/// The cells of the line that `lines` gave last, and its number. Throws InputError for a cell that its column cannot hold.
template <class Row>
void readRow(const std::string& file, const TableLayout<Row>& layout, const TableLines& lines, CampaignNames& names,
             Row& row) {
  row.line = lines.line();
  const bool room = lines.hasRoomBehindCells();
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    if (!lines.has(i)) continue;
    readCell(layout.columns[i], lines.cell(i), {file, row.line, layout.columns[i].name}, room, names, row);
  }
}

}  // namespace stiffscope
