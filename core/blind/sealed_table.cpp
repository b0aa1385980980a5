#include "core/blind/sealed_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/input/csv_lines.h"
#include "core/input/input_error.h"
#include "core/input/numbers.h"

namespace stiffscope::blind {

void TableRow::refuse(const std::string& column, const std::string& expected) const {
  throw InputError({file_, line_, column}, cells_.at(column), "expected " + expected);
}

double TableRow::number(const std::string& column) const {
  const ParsedNumber parsed = parseNumber(text(column));
  if (!parsed.expectation.empty()) throw InputError({file_, line_, column}, text(column), parsed.expectation);
  return parsed.value;
}

std::vector<double> TableRow::numbers(const std::string& column) const {
  std::vector<double> values;
  for (const std::string& part : split(text(column), '+')) {
    const ParsedNumber parsed = parseNumber(part);
    if (!parsed.expectation.empty()) throw InputError({file_, line_, column}, part, parsed.expectation);
    values.push_back(parsed.value);
  }
  return values;
}

std::vector<TableRow> readTable(const std::string& file, const std::string& bytes,
                                const std::vector<std::string>& columns) {
  CsvLines lines(file, bytes);
  std::vector<std::string_view> cells;
  std::vector<TableRow> rows;
  bool header = true;
  while (lines.next(cells)) {
    const bool expected = cells.size() == columns.size() &&
                          (!header || std::equal(cells.begin(), cells.end(), columns.begin()));
    if (!expected) {
      throw InputError({file, lines.line(), ""}, fmt::format("{}", fmt::join(cells, ",")),
                       fmt::format("expected {}{}", header ? "the header " : "a cell for each of ",
                                   fmt::join(columns, ",")));
    }
    std::map<std::string, std::string> named;
    for (std::size_t c = 0; c < columns.size(); ++c) named[columns[c]] = std::string(cells[c]);
    if (!header) rows.emplace_back(file, lines.line(), std::move(named));
    header = false;
  }
  return rows;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  if (text.empty()) return parts;
  std::size_t from = 0;
  for (std::size_t at = text.find(separator); at != std::string::npos; at = text.find(separator, from)) {
    parts.push_back(text.substr(from, at - from));
    from = at + 1;
  }
  parts.push_back(text.substr(from));
  return parts;
}

}  // namespace stiffscope::blind
