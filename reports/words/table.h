#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
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

/// A cell of a file: nothing, a number, or a plain text. A number that is not finite is nothing.
using DataCell = std::variant<std::monostate, double, std::string>;

/// What programs read: one quantity a column, the unit in its name ("stiffness_nm_per_rad"), numbers in full.
struct DataTable {
  std::vector<std::string> columns;
  std::vector<std::vector<DataCell>> rows;  ///< each as wide as the columns
};

/// A table of the page. Every text is rich.
struct Table {
  std::string caption;
  std::vector<std::string> columns;  ///< headers; one more than a row is wide where groups have headers
  std::vector<RowGroup> groups;
  bool words = false;                  ///< cells hold words, set flush left, not numbers
  std::string id = {};                 ///< of its file beside the page, without ".csv"; empty: by its number
  std::optional<DataTable> data = {};  ///< of its file, where cells for people are more than a number each
  bool on_page_alone = false;          ///< has no file: its numbers are in those of other tables
};

}  // namespace stiffscope::reports
