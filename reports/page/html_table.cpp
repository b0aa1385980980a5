#include "reports/page/html_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "reports/csv/csv_table.h"

namespace stiffscope::page {

namespace {

void writeCell(Html& html, const char* name, const Cell& cell, const Attributes& attributes = {}) {
  const auto element = html.element(name, attributes);
  html.rich(cell.text);
  if (!cell.remark.empty()) {
    html.text(" ");
    html.leaf("small", cell.remark);
  }
}

void writeGroup(Html& html, const RowGroup& group, std::size_t columns) {
  const auto body = html.element("tbody");
  bool first = true;
  for (const Row& row : group.rows) {
    if (row.size() + (group.header.empty() ? 0 : 1) != columns) {
      throw std::invalid_argument(
          fmt::format("a table row of {} cells under {} columns", row.size(), columns));
    }
    const auto line = html.element("tr");
    if (first && !group.header.empty()) {
      html.leaf("th", group.header, {{"scope", "rowgroup"}, {"rowspan", std::to_string(group.rows.size())}});
    }
    first = false;
    writeCell(html, "th", row.front(), {{"scope", "row"}});
    for (std::size_t i = 1; i < row.size(); ++i) writeCell(html, "td", row[i]);
  }
}

}  // namespace

void writeTable(Html& html, const Table& table) {
  const bool empty = std::all_of(table.groups.begin(), table.groups.end(),
                                 [](const RowGroup& group) { return group.rows.empty(); });
  if (empty) return;
  const std::string name = plain(table.caption);
  // A wide table is scrolled by keyboard too.
  const auto scroll = html.element(
      "div", {{"class", "scroll"}, {"role", "region"}, {"aria-label", name}, {"tabindex", "0"}});
  const bool grouped = std::any_of(table.groups.begin(), table.groups.end(),
                                   [](const RowGroup& group) { return !group.header.empty(); });
  std::size_t rows = 0;
  for (const RowGroup& group : table.groups) rows += group.rows.size();
  constexpr std::size_t kMostOnAPage = 16;  // a longer table is broken between groups, its head repeated
  std::string kind = table.words ? "words" : grouped ? "grouped" : "numeric";
  if (rows > kMostOnAPage || table.words) kind += " long";  // rows of words are high
  if (!grouped && !table.words && rows > 2) kind += " sorts";  // a group's header spans its rows in their order
  html.keepTable(table.id, csvTable(table));
  const auto element = html.element("table", {{"class", kind}});
  html.leaf("caption", table.caption);
  {
    const auto head = html.element("thead");
    const auto line = html.element("tr");
    for (const std::string& column : table.columns) html.leaf("th", column, {{"scope", "col"}});
  }
  for (const RowGroup& group : table.groups) {
    if (!group.rows.empty()) writeGroup(html, group, table.columns.size());
  }
}

std::string Notes::mark(const std::string& text) {
  const auto found = std::find(texts_.begin(), texts_.end(), text);
  const auto at = found - texts_.begin();
  if (found == texts_.end()) texts_.push_back(text);
  return std::string(1, static_cast<char>('a' + at % 26));
}

void Notes::write(Html& html) const {
  if (texts_.empty()) return;
  const auto list = html.element("ol", {{"class", "notes"}, {"type", "a"}});
  for (const std::string& text : texts_) html.leaf("li", text);
}

}  // namespace stiffscope::page
