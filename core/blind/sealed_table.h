#pragma once

#include <map>
#include <string>
#include <vector>

namespace stiffscope::blind {

/// A row of labels.csv or answers.csv, by column name. Throws InputError with file, line, column and value.
class TableRow {
 public:
  TableRow(std::string file, std::size_t line, std::map<std::string, std::string> cells)
      : file_(std::move(file)), line_(line), cells_(std::move(cells)) {}

  const std::string& text(const std::string& column) const { return cells_.at(column); }
  double number(const std::string& column) const;
  std::vector<double> numbers(const std::string& column) const;  ///< joined by '+'; none where empty
  [[noreturn]] void refuse(const std::string& column, const std::string& expected) const;

 private:
  std::string file_;
  std::size_t line_;
  std::map<std::string, std::string> cells_;
};

/// The rows of a table that has exactly these columns.
std::vector<TableRow> readTable(const std::string& file, const std::string& bytes,
                                const std::vector<std::string>& columns);

/// The parts between separators, empty ones kept ("a++b" has three); none of an empty text.
std::vector<std::string> split(const std::string& text, char separator);

}  // namespace stiffscope::blind
