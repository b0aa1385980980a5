#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace stiffscope::io {

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

  // Static, so that an object of this class can stay in registers.
  static std::uint64_t marksOfBlock(const char* block, const char* end);

  const char *end_, *block_ = nullptr;
  std::uint64_t marks_ = 0;  ///< of the block, those not yet handed out
};

/// Cuts a comma-separated table in memory into lines and cells, in one pass and without a copy of the text. Line ends
/// may be LF, CRLF or CR, a UTF-8 byte-order mark is skipped, blank lines are skipped (but counted), blanks around a
/// cell are cut off, and a cell may stand in double quotes, where two of them mean one. The cells are views that hold
/// until the next call.
class CsvLines {
 public:
  /// `file` is the name for messages; `bytes` must outlive this object. `lines_before`: where `bytes` do not start the
  /// file, but stand behind that many lines of it.
  CsvLines(std::string file, std::string_view bytes, std::size_t lines_before = 0);

  /// Of a line with more cells than a table can have, the first of them: a file of commas would take ten times its
  /// size.
  static constexpr std::size_t kMostKept = 4096;

  /// Cells of the next line that is not blank, kMostKept at most; false at the end. Throws InputError where a quote is
  /// not closed on its line, or something else than a comma follows one that is.
  bool next(std::vector<std::string_view>& cells);

  /// How many cells that line has.
  std::size_t cellCount() const { return cell_count_; }

  /// Line of the cells last given, counted from 1.
  std::size_t line() const { return line_; }

  /// Whether nothing stands behind the line last given, not even the end of that line.
  bool endsWithoutLineEnd() const { return rest_.empty() && !line_ended_; }

  /// What stands behind the line last given.
  std::string_view rest() const { return rest_; }

 private:
  bool nextPlain(std::vector<std::string_view>& cells);
  bool nextLine(std::string_view& line);
  std::string_view quotedCell(std::string_view& line);

  std::string file_;
  std::string_view rest_;
  std::size_t line_ = 0, cell_count_ = 0;
  bool line_ended_ = true;
  CsvMarks marks_;                     ///< in rest_
  const char* next_lf_ = nullptr;      ///< first LF in rest_; sought again only when it is passed
  std::deque<std::string> unescaped_;  ///< cells of this line that had doubled quotes
};

/// Lines as CsvLines cuts them, blank ones too.
std::size_t linesIn(std::string_view bytes);

/// `bytes`, whole lines as CsvLines cuts them, in parts of `least` bytes or a few more (the last may be smaller). Each
/// but the last ends with a LF, behind which a line starts whatever the others end with.
std::vector<std::string_view> partsOfLines(std::string_view bytes, std::size_t least);

}  // namespace stiffscope::io
