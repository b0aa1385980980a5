#include "core/campaign/read_table.h"

#include <fmt/format.h>
#include <algorithm>

#include "core/io/input_error.h"

namespace stiffscope::campaign {

namespace {

void refuseOtherSeparators(const std::string& file, std::size_t line, const std::vector<std::string_view>& cells) {
  for (const std::string_view cell : cells) {
    for (const auto& [separator, name] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}}) {
      if (cell.find(separator) == std::string_view::npos) continue;
      throw io::InputError({file, line, ""}, std::string(cell),
                           fmt::format("expected columns separated by commas and numbers with a decimal point; "
                                       "this header has {}",
                                       name));
    }
  }
}

std::vector<std::string> unknownColumns(const std::vector<std::string_view>& cells,
                                        const std::vector<WantedColumn>& wanted) {
  std::vector<std::string> unknown;
  for (const std::string_view cell : cells) {
    const auto matches = [&](const WantedColumn& column) { return column.name == cell; };
    if (!cell.empty() && std::none_of(wanted.begin(), wanted.end(), matches)) unknown.emplace_back(cell);
  }
  return unknown;
}

std::string unknownColumnsWarning(const std::vector<std::string>& unknown, const std::vector<std::string>& absent) {
  std::string list;
  for (const std::string& name : unknown) {
    list += fmt::format("{}'{}'{}", list.empty() ? "" : ", ", name, io::nearestNameHint(name, absent));
  }
  return fmt::format("unknown column{} ignored: {}", unknown.size() > 1 ? "s" : "", list);
}

/// What may stand there for `missing`, to end a message with; `known`: some other column is as it should be.
std::string insteadOf(const std::string& missing, const std::vector<std::string>& unknown, bool known) {
  const std::string near = io::nearestName(missing, unknown);
  if (!near.empty()) return fmt::format(" and has '{}'", near);
  for (const std::string& name : unknown) {
    std::string ascii = name;
    std::erase_if(ascii, [](char c) { return (c & 0x80) != 0; });
    if (ascii == missing)
      return fmt::format(" and has '{}' with a character that does not show (a no-break space?)", missing);
  }
  return known || unknown.empty() ? "" : fmt::format("; it starts with '{}'", io::oneLine(unknown.front(), 60));
}

/// Whether the header has any of the columns that are there together.
bool someOf(const std::string& together, const std::vector<WantedColumn>& wanted,
            const std::vector<std::string_view>& cells) {
  return !together.empty() && std::any_of(wanted.begin(), wanted.end(), [&](const WantedColumn& column) {
    return column.together == together && std::find(cells.begin(), cells.end(), column.name) != cells.end();
  });
}

}  // namespace

std::vector<std::size_t> matchHeader(const std::string& file, std::size_t line,
                                     const std::vector<std::string_view>& cells,
                                     const std::vector<WantedColumn>& wanted, std::vector<std::string>& warnings) {
  refuseOtherSeparators(file, line, cells);
  const std::vector<std::string> unknown = unknownColumns(cells, wanted);
  std::vector<std::size_t> places;
  std::vector<std::string> absent;
  for (const WantedColumn& column : wanted) {
    const auto found = std::find(cells.begin(), cells.end(), column.name);
    if (found == cells.end()) {
      if (column.required || someOf(column.together, wanted, cells)) {
        const auto named =
            std::count_if(cells.begin(), cells.end(), [](std::string_view cell) { return !cell.empty(); });
        const bool known = static_cast<std::ptrdiff_t>(unknown.size()) < named;
        throw io::InputError({file, line, column.name}, "",
                             "expected this column; the header lacks it" + insteadOf(column.name, unknown, known));
      }
      absent.push_back(column.name);
      places.push_back(kAbsentColumn);
      continue;
    }
    if (std::find(found + 1, cells.end(), column.name) != cells.end()) {
      throw io::InputError({file, line, column.name}, "", "expected this column once; the header has it twice");
    }
    places.push_back(static_cast<std::size_t>(found - cells.begin()));
  }
  if (!unknown.empty()) {
    warnings.push_back(io::inputMessage({file, line, ""}, "", unknownColumnsWarning(unknown, absent)));
  }
  return places;
}

TableLines::TableLines(const TableSource& source, const std::vector<WantedColumn>& wanted,
                       std::vector<std::string>& warnings)
    : source_(source), lines_(source.file, source.bytes), warnings_(warnings) {
  if (!lines_.next(cells_)) throw io::InputError({source.file, 0, ""}, "", "expected a header line; there is none");
  constexpr std::size_t kMostColumns = 1000;
  if (lines_.cellCount() > kMostColumns) {
    throw io::InputError({source.file, line(), ""}, fmt::format("{} columns", lines_.cellCount()),
                         fmt::format("expected at most {} columns", kMostColumns));
  }
  cells_in_header_ = cells_.size();
  places_ = matchHeader(source.file, line(), cells_, wanted, warnings);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (has(i)) shortest_row_ += wanted[i].required ? 2 : 1;
  }
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
      shortest_row_(table.shortest_row_),
      row_required_(false),
      warnings_(table.warnings_) {}

// The shortest row has one character and a separator a column, of an optional one perhaps the separator alone: that
// bounds the rows of a file of empty lines.
std::size_t TableLines::mostRows(std::size_t bytes, std::size_t lines) const {
  return std::min(lines, bytes / shortest_row_ + 1);
}

bool TableLines::next() {
  if (!lines_.next(cells_)) {
    if (rows_ == 0 && row_required_) {
      throw io::InputError({source_.file, 0, ""}, "", "expected at least one row below the header");
    }
    if (lines_.endsWithoutLineEnd()) {
      warnings_.push_back(io::inputMessage({source_.file, line(), ""}, "",
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
  if (lines_.cellCount() == cells_in_header_) return;
  const auto refuse = [&](const std::string& why) {
    throw io::InputError({source_.file, line(), ""}, fmt::format("{} cells", lines_.cellCount()),
                         fmt::format("expected {} cells, as the header has{}", cells_in_header_, why));
  };
  if (lines_.cellCount() > cells_in_header_) refuse("; a decimal comma splits a number in two, write a point");
  refuse(lines_.endsWithoutLineEnd() ? "; the file ends in the middle of this line" : "");
}

// With decimal commas a row may have as many cells as a header with nameless columns, all in the wrong place.
void TableLines::requireNothingWithoutName() const {
  for (const std::size_t i : nameless_) {
    if (cells_[i].empty()) continue;
    throw io::InputError({source_.file, line(), fmt::format("column {}", i + 1)}, std::string(cells_[i]),
                         "expected nothing in a column without a name; a decimal comma splits a number in two");
  }
}

}  // namespace stiffscope::campaign
