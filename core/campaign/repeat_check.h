#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

namespace stiffscope {

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

}  // namespace stiffscope
