#include "core/campaign/table_lines.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/input/input_error.h"

namespace stiffscope {

namespace {

bool endsWithLineEnd(std::string_view bytes) { return !bytes.empty() && bytes.back() == '\n'; }

}  // namespace

TableLines::TableLines(const TableSource& source, const std::vector<WantedColumn>& wanted,
                       std::vector<std::string>& warnings)
    : source_(source), lines_(source.file, source.bytes), warnings_(warnings) {
  if (!lines_.next(cells_))
    throw InputError({source.file, 0, ""}, "", "expected a header line; there is none");
  cells_in_header_ = cells_.size();
  places_ = matchHeader(source.file, line(), cells_, wanted, warnings);
}

bool TableLines::next() {
  const std::size_t previous = line();
  if (!lines_.next(cells_)) {
    if (rows_ == 0) {
      throw InputError({source_.file, 0, ""}, "", "expected at least one row below the header");
    }
    if (!endsWithLineEnd(source_.bytes)) {
      warnings_.push_back(
          inputMessage({source_.file, previous, ""}, "",
                       "the last line has no line end; its last cell may have been cut short"));
    }
    return false;
  }
  requireCellCount();
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
  const auto line_ends = std::count(source_.bytes.begin(), source_.bytes.end(), '\n');
  const bool cut = !endsWithLineEnd(source_.bytes) && line() == static_cast<std::size_t>(line_ends) + 1;
  refuse(cut ? "; the file ends in the middle of this line" : "");
}

}  // namespace stiffscope
