#pragma once

#include <string>
#include <vector>

#include "reports/page/html.h"

namespace stiffscope::page {

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
  bool words = false;  ///< cells hold words, set flush left, not numbers
  std::string id = {};  ///< of its file beside the page, without ".csv"; empty: by its number
};

/// Writes it with <caption> and a scope on every header. Empty tables (no rows) are not written.
/// Throws std::invalid_argument where a row's width is not that of the columns.
void writeTable(Html& html, const Table& table);

/// Remarks that cells refer to by a letter; the same text gets the same letter.
class Notes {
 public:
  std::string mark(const std::string& text);  ///< the letter of `text`
  void write(Html& html) const;               ///< the list of them

 private:
  std::vector<std::string> texts_;
};

}  // namespace stiffscope::page
