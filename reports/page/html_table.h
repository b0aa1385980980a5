#pragma once

#include <string>
#include <vector>

#include "reports/page/html.h"
#include "reports/table.h"

namespace stiffscope::page {

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
