#include "core/campaign/table_lines.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/input/input_error.h"

namespace stiffscope {

TableLines::TableLines(const TableSource& source, const std::vector<WantedColumn>& wanted,
                       std::vector<std::string>& warnings)
    : source_(source), lines_(source.file, source.bytes), warnings_(warnings) {
  if (!lines_.next(cells_))
    throw InputError({source.file, 0, ""}, "", "expected a header line; there is none");
  constexpr std::size_t kMostColumns = 1000;
  if (cells_.size() > kMostColumns) {
    throw InputError({source.file, line(), ""}, fmt::format("{} columns", cells_.size()),
                     fmt::format("expected at most {} columns", kMostColumns));
  }
  cells_in_header_ = cells_.size();
  places_ = matchHeader(source.file, line(), cells_, wanted, warnings);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].empty()) nameless_.push_back(i);
  }
}

TableLines::TableLines(const TableLines& table, std::string_view part, std::size_t lines_before)
    : source_(table.source_),
      lines_(table.source_.file, part, lines_before),
      places_(table.places_),
      nameless_(table.nameless_),
      cells_in_header_(table.cells_in_header_),
      row_required_(false),
      warnings_(table.warnings_) {}

// The shortest row has one character and a separator a column: that bounds the rows of a file of empty lines.
std::size_t TableLines::mostRows(std::size_t bytes, std::size_t lines) const {
  return std::min(lines, bytes / (2 * places_.size()) + 1);
}

bool TableLines::next() {
  if (!lines_.next(cells_)) {
    if (rows_ == 0 && row_required_) {
      throw InputError({source_.file, 0, ""}, "", "expected at least one row below the header");
    }
    if (lines_.endsWithoutLineEnd()) {
      warnings_.push_back(
          inputMessage({source_.file, line(), ""}, "",
                       "the last line has no line end; its last cell may have been cut short"));
    }
    return false;
  }
  requireCellCount();
  requireNothingWithoutName();
  ++rows_;
  return true;
}

void TableLines::requireCellCount() const {
  if (cells_.size() == cells_in_header_) return;
  const auto refuse = [&](const std::string& why) {
    throw InputError({source_.file, line(), ""}, fmt::format("{} cells", cells_.size()),
                     fmt::format("expected {} cells, as the header has{}", cells_in_header_, why));
  };
  if (cells_.size() > cells_in_header_) refuse("; a decimal comma splits a number in two, write a point");
  refuse(lines_.endsWithoutLineEnd() ? "; the file ends in the middle of this line" : "");
}

// With decimal commas a row may have as many cells as a header with nameless columns, all in the wrong place.
void TableLines::requireNothingWithoutName() const {
  for (const std::size_t i : nameless_) {
    if (cells_[i].empty()) continue;
    throw InputError({source_.file, line(), fmt::format("column {}", i + 1)}, std::string(cells_[i]),
                     "expected nothing in a column without a name; a decimal comma splits a number in two");
  }
}

}  // namespace stiffscope
