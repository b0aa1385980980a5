#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <optional>
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

/// The columns of a layout that together must not repeat, and their places in it.
template <class Row>
struct KeyColumns {
  explicit KeyColumns(const TableLayout<Row>& layout) {
    for (std::size_t i = 0; i < layout.columns.size(); ++i) {
      const std::string& name = layout.columns[i].name;
      if (std::find(layout.key.begin(), layout.key.end(), name) == layout.key.end()) continue;
      columns.push_back(&layout.columns[i]);
      places.push_back(i);
    }
  }

  KeyHash hash(Row& row) const {
    KeyHash hash;
    for (const Column<Row>* column : columns) {
      std::visit([&](auto member) { hash.add(member(row)); }, column->member);
    }
    return hash;
  }

  bool same(Row& a, Row& b) const {
    return std::all_of(columns.begin(), columns.end(), [&](const Column<Row>* column) {
      return std::visit([&](auto member) { return member(a) == member(b); }, column->member);
    });
  }

  /// An order of keys, of texts by length first, so that numbers are in the order of their values.
  bool less(Row& a, Row& b) const {
    int order = 0;
    for (const Column<Row>* column : columns) {
      std::visit([&](auto member) { order = ordered(member(a), member(b)); }, column->member);
      if (order != 0) break;
    }
    return order < 0;
  }

  std::vector<const Column<Row>*> columns;
  std::vector<std::size_t> places;

 private:
  template <class Number>
  static int ordered(Number a, Number b) {
    return a < b ? -1 : b < a ? 1 : 0;
  }
  static int ordered(const std::string& a, const std::string& b) {
    return a.size() == b.size() ? a.compare(b) : a.size() < b.size() ? -1 : 1;
  }
};

/// Finds the row that the last one repeats. As long as the keys ascend, as they do in most tables, a look at the row
/// before is enough; from the first that does not on, every key is looked up.
template <class Row>
class RowRepeats {
 public:
  RowRepeats(const KeyColumns<Row>& key, std::vector<Row>& rows) : key_(key), rows_(rows) {}

  /// Place of the row that has the key of the last one, or RepeatCheck::kNew.
  std::size_t ofLast() {
    const std::size_t last = rows_.size() - 1;
    if (!seen_) {
      if (last == 0 || key_.less(rows_[last - 1], rows_[last])) return RepeatCheck::kNew;
      seen_.emplace(rows_.capacity());
      for (std::size_t row = 0; row < last; ++row) add(row);
    }
    return add(last);
  }

 private:
  std::size_t add(std::size_t row) {
    const auto same = [&](std::size_t other) { return key_.same(rows_[row], rows_[other]); };
    return seen_->add(row, key_.hash(rows_[row]), same);
  }

  const KeyColumns<Row>& key_;
  std::vector<Row>& rows_;
  std::optional<RepeatCheck> seen_;
};

template <class Row>
[[noreturn]] void refuseRepeat(const TableSource& source, const TableLayout<Row>& layout,
                               const KeyColumns<Row>& key, const TableLines& lines, std::size_t first_line) {
  std::vector<std::string_view> cells;
  for (const std::size_t i : key.places) cells.push_back(lines.cell(i));
  throw InputError({source.file, lines.line(), fmt::format("{}", fmt::join(layout.key, ", "))},
                   fmt::format("{}", fmt::join(cells, ", ")),
                   fmt::format("expected a key that does not repeat; line {} has it first", first_line));
}

/// Rows of a table that `layout` describes, in the order of the file. Throws InputError with file, line,
/// column and value for anything the format does not allow, keys that repeat among it.
template <class Row>
std::vector<Row> readTable(const TableSource& source, const TableLayout<Row>& layout, CampaignNames& names,
                           std::vector<std::string>& warnings) {
  std::vector<WantedColumn> wanted;
  for (const Column<Row>& column : layout.columns) wanted.push_back({column.name, column.required});
  const KeyColumns<Row> key(layout);

  TableLines lines(source, wanted, warnings);
  std::vector<Row> rows;
  rows.reserve(lines.expectedRows());
  RowRepeats<Row> repeats(key, rows);
  while (lines.next()) {
    Row& row = rows.emplace_back();
    row.line = lines.line();
    for (std::size_t i = 0; i < layout.columns.size(); ++i) {
      if (!lines.has(i)) continue;
      readCell(layout.columns[i], lines.cell(i), {source.file, row.line, layout.columns[i].name}, names, row);
    }
    const std::size_t first = repeats.ofLast();
    if (first != RepeatCheck::kNew) refuseRepeat(source, layout, key, lines, rows[first].line);
  }
  return rows;
}

}  // namespace stiffscope
