#include "reports/csv/csv_table.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "reports/words/rich_text.h"

namespace stiffscope::reports {

namespace {

constexpr const char* kPlusMinus = " ± ";

using Line = std::vector<std::string>;

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

std::string asData(const std::string& rich_text) {
  std::string text = plain(rich_text);
  if (text == "–") return {};
  replaceAll(text, "−", "-");
  replaceAll(text, "\u00a0", " ");
  return text;
}

/// Headers and rows with the groups' headers repeated in every row.
std::vector<Line> linesOf(const Table& table) {
  std::vector<Line> lines{Line()};
  for (const std::string& column : table.columns) lines.front().push_back(asData(column));
  lines.front().emplace_back("Remark");
  bool remarks = false;
  for (const RowGroup& group : table.groups) {
    for (const Row& row : group.rows) {
      Line line;
      if (!group.header.empty()) line.push_back(asData(group.header));
      std::string remark;
      for (const Cell& cell : row) {
        line.push_back(asData(cell.text));
        if (!cell.remark.empty()) remark += (remark.empty() ? "" : "; ") + plain(cell.remark);
      }
      remarks = remarks || !remark.empty();
      line.push_back(std::move(remark));
      lines.push_back(std::move(line));
    }
  }
  for (Line& line : lines) {
    if (!remarks) line.pop_back();
  }
  return lines;
}

void splitUncertainties(std::vector<Line>& lines) {
  for (std::size_t column = 0; column < lines.front().size(); ++column) {
    const bool any = std::any_of(lines.begin() + 1, lines.end(), [column](const Line& line) {
      return line[column].find(kPlusMinus) != std::string::npos;
    });
    const bool in_header = lines.front()[column].find(kPlusMinus) != std::string::npos;
    if (!any) continue;
    for (Line& line : lines) {
      const std::size_t at = line[column].find(kPlusMinus);
      std::string after;
      if (&line == &lines.front()) {
        after = in_header ? line[column].substr(at + std::string(kPlusMinus).size()) : "± of " + line[column];
      } else if (at != std::string::npos) {
        after = line[column].substr(at + std::string(kPlusMinus).size());
      }
      if (at != std::string::npos) line[column].resize(at);
      line.insert(line.begin() + static_cast<std::ptrdiff_t>(column) + 1, after);
    }
    ++column;
  }
}

}  // namespace

std::string csvField(const std::string& field) {
  if (field.find_first_of("\",\r\n") == std::string::npos) return field;
  std::string text = field;
  replaceAll(text, "\"", "\"\"");
  return '"' + text + '"';
}

namespace {

std::string csvOf(const std::vector<Line>& lines) {
  std::string csv;
  for (const Line& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) csv += (i > 0 ? "," : "") + csvField(line[i]);
    csv += "\r\n";
  }
  return csv;
}

std::string dataText(const DataCell& cell) {
  if (const double* number = std::get_if<double>(&cell))
    return std::isfinite(*number) ? fmt::format("{:.10g}", *number) : std::string();
  const std::string* text = std::get_if<std::string>(&cell);
  return text != nullptr ? *text : std::string();
}

}  // namespace

std::string csvTable(const DataTable& table) {
  std::vector<Line> lines{table.columns};
  for (const std::vector<DataCell>& row : table.rows) {
    if (row.size() != table.columns.size())
      throw std::invalid_argument(fmt::format("a row of {} cells under {} columns", row.size(), table.columns.size()));
    Line& line = lines.emplace_back();
    for (const DataCell& cell : row) line.push_back(dataText(cell));
  }
  return csvOf(lines);
}

std::string csvTable(const Table& table) {
  if (table.data) return csvTable(*table.data);
  std::vector<Line> lines = linesOf(table);
  splitUncertainties(lines);
  return csvOf(lines);
}

}  // namespace stiffscope::reports
