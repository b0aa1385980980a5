#pragma once

#include <string>

#include "reports/words/table.h"

namespace stiffscope::reports {

/// A table of the page as a file (RFC 4180).
struct TableFile {
  std::string name;  ///< without ".csv"
  std::string csv;
};

/// CSV (RFC 4180: comma, CRLF, quotes doubled), UTF-8, headers first; numbers to ten digits. Throws
/// std::invalid_argument where a row's width is not that of the columns.
std::string csvTable(const DataTable& table);

/// A table of the page as such a file: its `data`, where it has that. Else its cells, numbers as a program reads them:
/// an ASCII minus, nothing for what is no number; a column of "value ± uncertainty" becomes two. Remarks follow in a
/// column of their own where there are any.
std::string csvTable(const Table& table);

/// A field as RFC 4180 has it: in quotes, and these doubled, where it holds a comma, a quote or a line end.
std::string csvField(const std::string& field);

}  // namespace stiffscope::reports
