#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/campaign/columns.h"

namespace stiffscope::campaign {

/// Hash of a key's parts, taken by value and not as written, so that steps "1" and "01" are the same one.
class KeyHash {
 public:
  void add(int part) { mix(static_cast<std::uint64_t>(part)); }
  void add(double part) { mix(std::bit_cast<std::uint64_t>(part == 0.0 ? 0.0 : part)); }  // -0 equals 0
  void add(std::string_view part) { mix(std::hash<std::string_view>{}(part)); }

  std::uint64_t value() const { return hash_; }

 private:
  // The last steps of MurmurHash3: every bit of the part reaches every bit of the hash.
  void mix(std::uint64_t part) {
    hash_ = (hash_ + 0x9e3779b97f4a7c15ull) ^ part;
    hash_ = (hash_ ^ (hash_ >> 33)) * 0xff51afd7ed558ccdull;
    hash_ = (hash_ ^ (hash_ >> 33)) * 0xc4ceb9fe1a85ec53ull;
    hash_ ^= hash_ >> 33;
  }

  std::uint64_t hash_ = 0;
};

/// Finds rows whose key was there before. It holds the rows' numbers and hashes alone, 16 to 32 bytes a row; the keys
/// stay in the rows. Rows are fewer than 2^32, which the largest file that is read ensures.
class RepeatCheck {
 public:
  static constexpr std::size_t kNew = std::numeric_limits<std::size_t>::max();

  explicit RepeatCheck(std::size_t rows_expected) : slots_(std::bit_ceil(2 * rows_expected + 16)) {}

  /// The earlier row with the key of `row`, or kNew. `same(other)` compares the keys of `row` and an earlier row.
  template <class Same>
  std::size_t add(std::size_t row, const KeyHash& key, const Same& same) {
    if (2 * (rows_ + 1) > slots_.size()) grow();
    const Slot added{static_cast<std::uint32_t>(row + 1), static_cast<std::uint32_t>(key.value())};
    std::size_t place = startOf(added);
    for (; slots_[place].row_plus_one != 0; place = after(place)) {
      const std::size_t other = slots_[place].row_plus_one - 1;
      if (slots_[place].hash == added.hash && same(other)) return other;
    }
    slots_[place] = added;
    ++rows_;
    return kNew;
  }

 private:
  struct Slot {
    std::uint32_t row_plus_one = 0;  ///< 0: free
    std::uint32_t hash = 0;
  };

  std::size_t startOf(const Slot& slot) const { return slot.hash & (slots_.size() - 1); }
  std::size_t after(std::size_t place) const { return (place + 1) & (slots_.size() - 1); }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.row_plus_one == 0) continue;
      std::size_t place = startOf(slot);
      while (slots_[place].row_plus_one != 0) place = after(place);
      slots_[place] = slot;
    }
  }

  std::vector<Slot> slots_;
  std::size_t rows_ = 0;
};

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

}  // namespace stiffscope::campaign
