#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/repeat_check.h"
#include "core/campaign/table_layout.h"

namespace stiffscope {

/// The columns of a layout that together must not repeat, and their places in it.
template <class Row>
struct KeyColumns {
  explicit KeyColumns(const TableLayout<Row>& layout) {
    for (std::size_t i = 0; i < layout.columns.size(); ++i) {
      const std::string& name = layout.columns[i].name;
      if (std::find(layout.key.begin(), layout.key.end(), name) == layout.key.end()) continue;
      columns.push_back(&layout.columns[i]);
      places.push_back(i);
    }
  }

  KeyHash hash(Row& row) const {
    KeyHash hash;
    for (const Column<Row>* column : columns) {
      std::visit([&](auto member) { hash.add(member(row)); }, column->member);
    }
    return hash;
  }

  bool same(Row& a, Row& b) const {
    return std::all_of(columns.begin(), columns.end(), [&](const Column<Row>* column) {
      return std::visit([&](auto member) { return member(a) == member(b); }, column->member);
    });
  }

  /// An order of keys, of texts by length first, so that numbers are in the order of their values.
  bool less(Row& a, Row& b) const {
    int order = 0;
    for (const Column<Row>* column : columns) {
      std::visit([&](auto member) { order = ordered(member(a), member(b)); }, column->member);
      if (order != 0) break;
    }
    return order < 0;
  }

  std::vector<const Column<Row>*> columns;
  std::vector<std::size_t> places;

 private:
  template <class Number>
  static int ordered(Number a, Number b) {
    return a < b ? -1 : b < a ? 1 : 0;
  }
  static int ordered(const std::string& a, const std::string& b) {
    return a.size() == b.size() ? a.compare(b) : a.size() < b.size() ? -1 : 1;
  }
};

/// Finds the row that a later one repeats; asked of one row after the other, from the first on. As long as the keys
/// ascend, as they do in most tables, a look at the row before is enough; from the first that does not on, every key is
/// looked up.
template <class Row>
class RowRepeats {
 public:
  RowRepeats(const KeyColumns<Row>& key, std::vector<Row>& rows) : key_(key), rows_(rows) {}

  /// Place of the earlier row that has the key of this one, or RepeatCheck::kNew.
  std::size_t of(std::size_t row) {
    if (!seen_) {
      if (row == 0 || key_.less(rows_[row - 1], rows_[row])) return RepeatCheck::kNew;
      seen_.emplace(rows_.capacity());
      for (std::size_t earlier = 0; earlier < row; ++earlier) add(earlier);
    }
    return add(row);
  }

 private:
  std::size_t add(std::size_t row) {
    const auto same = [&](std::size_t other) { return key_.same(rows_[row], rows_[other]); };
    return seen_->add(row, key_.hash(rows_[row]), same);
  }

  const KeyColumns<Row>& key_;
  std::vector<Row>& rows_;
  std::optional<RepeatCheck> seen_;
};

}  // namespace stiffscope
