#include <fmt/format.h>
#include <algorithm>

#include "reports/text/text.h"
#include "reports/words/numbers.h"
#include "reports/words/rich_text.h"
#include "reports/words/stated_comparison_words.h"

namespace stiffscope::reports {

namespace {

/// Characters on a terminal: bytes that begin one.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string blanks(width - std::min(width, widthOf(text)), ' ');
  return left ? text + blanks : blanks + text;
}

/// Columns as wide as their widest cell; headers of two words may stand in less.
std::string tableText(const Table& table) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> group_of;
  const std::size_t shift = table.groups.front().header.empty() ? 0 : 1;
  rows.emplace_back();
  for (std::size_t i = shift; i < table.columns.size(); ++i) rows.back().push_back(plain(table.columns[i]));
  group_of.emplace_back();
  for (const RowGroup& group : table.groups) {
    for (const Row& row : group.rows) {
      rows.emplace_back();
      for (const Cell& cell : row) rows.back().push_back(plain(cell.text));
      group_of.push_back(plain(group.header));
    }
  }
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], widthOf(row[i]));
  }
  std::string text = "\n" + wrapped(plain(table.caption), 2) + "\n";
  std::string group;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (group_of[r] != group) text += "  " + (group = group_of[r]) + "\n";
    std::string line = " ";
    for (std::size_t i = 0; i < rows[r].size(); ++i)
      line += (i == 0 ? " " : "  ") + padded(rows[r][i], widths[i], i == 0);
    text += line + "\n";
  }
  return text;
}

/// A table of words, a line each cell.
std::string wordsText(const Table& table) {
  std::string text = "\n" + plain(table.caption) + "\n";
  for (const Row& row : table.groups.front().rows) {
    const std::string before = plain(row[1].text), after = plain(row[2].text);
    text += "  " + wrapped(fmt::format("{}, before: {}", plain(row[0].text), before.empty() ? "-" : before), 4) + "\n";
    text += "  " + wrapped(fmt::format("{}, after:  {}", plain(row[0].text), after.empty() ? "-" : after), 4) + "\n";
  }
  return text;
}

}  // namespace

std::string statedComparisonText(const StatedComparison& comparison) {
  if (!comparison.refused.empty()) return wrapped("Not compared: " + comparison.refused + ".", 2) + "\n";
  std::string text;
  for (const std::string& said : saidOfBoth(comparison)) text += wrapped(plain(said), 2) + "\n";
  if (const std::string changed = changedWords(comparison); !changed.empty()) text += "\n" + wrapped(changed, 2) + "\n";
  for (const std::string& caution : comparison.cautions) text += "  " + wrapped("caution: " + plain(caution), 4) + "\n";
  for (const Table& table : statedTables(comparison)) text += table.words ? wordsText(table) : tableText(table);
  for (const std::string& one : comparison.unmatched) text += "  not compared: posture " + one + "\n";
  return text;
}

}  // namespace stiffscope::reports
