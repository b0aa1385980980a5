#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace stiffscope {

/// The places in a text of the bytes that end a cell or a line of a comma-separated table, one after the
/// other, and of some that do not: quotes, blanks, and what else stands at or before the comma in ASCII,
/// which numbers and names seldom have. Found for 64 bytes at a time, a bit each: with a dozen bytes a cell
/// most of the time of reading would go into looking at them one by one.
class CsvMarks {
 public:
  explicit CsvMarks(std::string_view text) : end_(text.data() + text.size()) { seek(text.data()); }

  /// Goes on from there.
  void seek(const char* from) {
    block_ = from;
    marks_ = marksOfBlock(block_, end_);
  }

  /// The next byte that is no more than a comma; the end of the text where there is none.
  const char* next() {
    while (marks_ == 0) {
      if (end_ - block_ <= kBlock) return end_;
      block_ += kBlock;
      marks_ = marksOfBlock(block_, end_);
    }
    const char* const mark = block_ + std::countr_zero(marks_);
    marks_ &= marks_ - 1;
    return mark;
  }

 private:
  static constexpr int kBlock = 64;

  // Of what it is given, so that an object of this class can stay in registers.
  static std::uint64_t marksOfBlock(const char* block, const char* end);

  const char *end_, *block_ = nullptr;
  std::uint64_t marks_ = 0;  ///< of the block, those not yet handed out
};

}  // namespace stiffscope
