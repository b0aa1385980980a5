#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/campaign/repeat_check.h"
#include "core/campaign/table_layout.h"
#include "core/campaign/table_lines.h"
#include "core/input/input_error.h"

namespace stiffscope {

/// Puts one cell into its member of the row, in SI and radians.
template <class Row>
void readCell(const Column<Row>& column, std::string_view cell, const CellPlace& place, CampaignNames& names,
              Row& row) {
  if (const auto* number = std::get_if<typename Column<Row>::Number>(&column.member)) {
    (*number)(row) = readNumberCell(column.kind, cell, place);
  } else if (const auto* index = std::get_if<typename Column<Row>::Index>(&column.member)) {
    (*index)(row) = readIndexCell(column.kind, cell, place, names);
  } else {
    std::get<typename Column<Row>::Text>(column.member)(row) = readTextCell(cell, place);
  }
}

/// Line that had this row's key first, 0 where the key is new.
template <class Row>
std::size_t lineWithSameKey(const std::vector<const Column<Row>*>& key, Row& row, RepeatCheck& seen) {
  for (const Column<Row>* column : key) {
    std::visit([&](auto member) { seen.add(member(row)); }, column->member);
  }
  return seen.finish(row.line);
}

/// Rows of a table that `layout` describes, in the order of the file. Throws InputError with file, line,
/// column and value for anything the format does not allow, keys that repeat among it.
template <class Row>
std::vector<Row> readTable(const TableSource& source, const TableLayout<Row>& layout, CampaignNames& names,
                           std::vector<std::string>& warnings) {
  std::vector<WantedColumn> wanted;
  std::vector<const Column<Row>*> key;
  std::vector<std::size_t> key_places;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const Column<Row>& column = layout.columns[i];
    wanted.push_back({column.name, column.required});
    if (std::find(layout.key.begin(), layout.key.end(), column.name) == layout.key.end()) continue;
    key.push_back(&column);
    key_places.push_back(i);
  }

  TableLines lines(source, wanted, warnings);
  RepeatCheck seen;
  std::vector<Row> rows;
  while (lines.next()) {
    Row row;
    row.line = lines.line();
    for (std::size_t i = 0; i < layout.columns.size(); ++i) {
      if (!lines.has(i)) continue;
      readCell(layout.columns[i], lines.cell(i), {source.file, row.line, layout.columns[i].name}, names, row);
    }
    if (const std::size_t first = lineWithSameKey(key, row, seen); first > 0) {
      std::vector<std::string_view> cells;
      for (const std::size_t i : key_places) cells.push_back(lines.cell(i));
      throw InputError({source.file, row.line, fmt::format("{}", fmt::join(layout.key, ", "))},
                       fmt::format("{}", fmt::join(cells, ", ")),
                       fmt::format("expected a key that does not repeat; line {} has it first", first));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace stiffscope
