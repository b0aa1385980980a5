#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace stiffscope {

/// Cuts a comma-separated table in memory into lines and cells. Line ends may be LF or CRLF, a UTF-8 byte
/// order mark is skipped, blank lines are skipped (but counted), blanks around a cell are cut off, and a cell
/// may stand in double quotes. The cells are views that hold until the next call.
class CsvLines {
 public:
  /// `file` is the name for messages; `bytes` must outlive this object.
  CsvLines(std::string file, std::string_view bytes);
  ~CsvLines();
  CsvLines(const CsvLines&) = delete;
  CsvLines& operator=(const CsvLines&) = delete;

  /// Cells of the next line that is not blank; false at the end. Throws InputError where a line is longer
  /// than the tokenizer holds (16 MB) or a quote is not closed.
  bool next(std::vector<std::string_view>& cells);

  /// Line of the cells last given, counted from 1.
  std::size_t line() const;

 private:
  struct Reader;
  std::string file_;
  std::unique_ptr<Reader> reader_;
};

}  // namespace stiffscope
