#include "core/campaign/table_header.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/input/input_error.h"
#include "core/input/nearest_name.h"
#include "core/input/one_line.h"

namespace stiffscope {

namespace {

void refuseOtherSeparators(const std::string& file, std::size_t line,
                           const std::vector<std::string_view>& cells) {
  for (const std::string_view cell : cells) {
    for (const auto& [separator, name] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}}) {
      if (cell.find(separator) == std::string_view::npos) continue;
      throw InputError({file, line, ""}, std::string(cell),
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

std::string unknownColumnsWarning(const std::vector<std::string>& unknown,
                                  const std::vector<std::string>& absent) {
  std::string list;
  for (const std::string& name : unknown) {
    list += fmt::format("{}'{}'{}", list.empty() ? "" : ", ", name, nearestNameHint(name, absent));
  }
  return fmt::format("unknown column{} ignored: {}", unknown.size() > 1 ? "s" : "", list);
}

/// What may stand there for `missing`, to end a message with; `known`: some other column is as it should be.
std::string insteadOf(const std::string& missing, const std::vector<std::string>& unknown, bool known) {
  const std::string near = nearestName(missing, unknown);
  if (!near.empty()) return fmt::format(" and has '{}'", near);
  for (const std::string& name : unknown) {
    std::string ascii = name;
    std::erase_if(ascii, [](char c) { return (c & 0x80) != 0; });
    if (ascii == missing) return fmt::format(" and has '{}' with a character that does not show (a no-break space?)", missing);
  }
  return known || unknown.empty() ? "" : fmt::format("; it starts with '{}'", oneLine(unknown.front(), 60));
}

}  // namespace

std::vector<std::size_t> matchHeader(const std::string& file, std::size_t line,
                                     const std::vector<std::string_view>& cells,
                                     const std::vector<WantedColumn>& wanted,
                                     std::vector<std::string>& warnings) {
  refuseOtherSeparators(file, line, cells);
  const std::vector<std::string> unknown = unknownColumns(cells, wanted);
  std::vector<std::size_t> places;
  std::vector<std::string> absent;
  for (const WantedColumn& column : wanted) {
    const auto found = std::find(cells.begin(), cells.end(), column.name);
    if (found == cells.end()) {
      if (column.required) {
        const auto named = std::count_if(cells.begin(), cells.end(), [](std::string_view cell) { return !cell.empty(); });
        const bool known = static_cast<std::ptrdiff_t>(unknown.size()) < named;
        throw InputError({file, line, column.name}, "",
                         "expected this column; the header lacks it" + insteadOf(column.name, unknown, known));
      }
      absent.push_back(column.name);
      places.push_back(kAbsentColumn);
      continue;
    }
    if (std::find(found + 1, cells.end(), column.name) != cells.end()) {
      throw InputError({file, line, column.name}, "", "expected this column once; the header has it twice");
    }
    places.push_back(static_cast<std::size_t>(found - cells.begin()));
  }
  if (!unknown.empty()) {
    warnings.push_back(inputMessage({file, line, ""}, "", unknownColumnsWarning(unknown, absent)));
  }
  return places;
}

}  // namespace stiffscope
