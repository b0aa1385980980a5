#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "core/campaign/key_columns.h"
#include "core/campaign/read_row.h"
#include "core/campaign/table_layout.h"
#include "core/campaign/table_lines.h"
#include "core/campaign/table_parts.h"
#include "core/input/input_error.h"

namespace stiffscope {

template <class Row>
[[noreturn]] void refuseRepeat(const TableSource& source, const TableLayout<Row>& layout,
                               const KeyColumns<Row>& key, const TableLines& lines, std::size_t first_line) {
  std::vector<std::string_view> cells;
  for (const std::size_t i : key.places) cells.push_back(lines.cell(i));
  throw InputError({source.file, lines.line(), fmt::format("{}", fmt::join(layout.key, ", "))},
                   fmt::format("{}", fmt::join(cells, ", ")),
                   fmt::format("expected a key that does not repeat; line {} has it first", first_line));
}

/// readTable line after line; the error it throws is the first of the file.
template <class Row>
std::vector<Row> readTableInOneGo(const TableSource& source, const TableLayout<Row>& layout, CampaignNames& names,
                                  std::vector<std::string>& warnings) {
  const KeyColumns<Row> key(layout);
  TableLines lines(source, wantedColumns(layout), warnings);
  std::vector<Row> rows;
  rows.reserve(lines.mostRows(lines.rest().size(), linesIn(lines.rest())));
  RowRepeats<Row> repeats(key, rows);
  const RowReader<Row> reader(source.file, layout, lines);
  while (lines.next()) {
    reader.read(lines, names, rows.emplace_back());
    const std::size_t first = repeats.of(rows.size() - 1);
    if (first != RepeatCheck::kNew) refuseRepeat(source, layout, key, lines, rows[first].line);
  }
  return rows;
}

/// Rows of a table that `layout` describes, in the order of the file. Throws InputError with file, line,
/// column and value for anything the format does not allow, keys that repeat among it. A text larger than `part_bytes`
/// is read in parts of that size on all cores (table_parts.h); rows, names, warnings and errors are those of the
/// reading in one go.
template <class Row>
std::vector<Row> readTable(const TableSource& source, const TableLayout<Row>& layout, CampaignNames& names,
                           std::vector<std::string>& warnings, std::size_t part_bytes = kPartBytes) {
  const std::size_t warned = warnings.size();
  if (source.bytes.size() > part_bytes) {
    if (auto rows = readTableInParts(source, layout, names, warnings, part_bytes)) return *std::move(rows);
    warnings.resize(warned);
  }
  return readTableInOneGo(source, layout, names, warnings);
}

}  // namespace stiffscope
