#pragma once

#include <string>
#include <utility>
#include <vector>

namespace stiffscope::reports {

/// A cell: rich text, and a remark in small type after it ("negative").
struct Cell {
  Cell(std::string text = {}, std::string remark = {}) : text(std::move(text)), remark(std::move(remark)) {}
  Cell(const char* text) : text(text) {}

  std::string text, remark;
};

/// A row: its header first. Shorter rows than the table is wide are not allowed.
using Row = std::vector<Cell>;

/// Rows under one header that spans them; without a header plain rows.
struct RowGroup {
  std::string header;
  std::vector<Row> rows;
};

/// A table as data. Every text is rich.
struct Table {
  std::string caption;
  std::vector<std::string> columns;  ///< headers; one more than a row is wide where groups have headers
  std::vector<RowGroup> groups;
  bool words = false;   ///< cells hold words, set flush left, not numbers
  std::string id = {};  ///< of its file beside the page, without ".csv"; empty: by its number
};

}  // namespace stiffscope::reports
