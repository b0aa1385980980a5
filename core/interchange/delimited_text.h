#pragma once

#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace stiffscope::interchange {

/// A line of a text, without its end.
struct TextLine {
  std::string_view text;
  std::size_t number = 0;  ///< counted from 1
  bool ended = true;       ///< false: the file stops behind it
};

/// All lines of a text, blank ones too, one after the other: a file of 100 MB may have fifty million. They end with LF,
/// CRLF or CR.
class LinesOfText {
 public:
  explicit LinesOfText(std::string_view text) : text_(text) {}

  struct End {};
  class Iterator {
   public:
    explicit Iterator(std::string_view text) : rest_(text) { ++*this; }
    const TextLine& operator*() const { return line_; }
    Iterator& operator++();
    bool operator==(End) const { return at_end_; }

   private:
    std::string_view rest_;
    TextLine line_;
    bool at_end_ = false;
  };

  Iterator begin() const { return Iterator(text_); }
  End end() const { return {}; }

 private:
  std::string_view text_;
};

inline LinesOfText linesOf(std::string_view text) { return LinesOfText(text); }

/// Throws InputError where a line is longer than any of a table or a program: cells of a line of 100 MB would take 48
/// times as much. `file` is its name for messages.
void requireLines(const std::string& file, std::string_view text);

/// Without blanks at both ends; tabs and the no-break space are blanks.
std::string_view trimmed(std::string_view text);

/// Cells between separators, trimmed and without the double quotes around them, in which separators are text (RFC
/// 4180). A cell with quotes in its quotes, each written twice, stays as it is written: cellText. Nothing between two
/// separators is a cell. They are views into the line, which must outlive them: a temporary is refused by the compiler.
std::vector<std::string_view> cellsBetween(std::string_view line, char separator);
template <std::same_as<std::string> Temporary>
void cellsBetween(Temporary&& line, char separator) = delete;

/// What a cell says: `"a ""b"" c"` is a "b" c. A cell that is not written so is its own text.
std::string cellText(std::string_view cell);

/// Cells between runs of at least `least` blanks; a tab counts as many as it takes. Views into the line, as above.
std::vector<std::string_view> cellsBetweenBlanks(std::string_view line, std::size_t least);
template <std::same_as<std::string> Temporary>
void cellsBetweenBlanks(Temporary&& line, std::size_t least) = delete;

/// Longest run of blanks between two other characters.
std::size_t longestBlanks(std::string_view line);

enum class DecimalSign { point, comma };

/// A finite number with that decimal sign; NaN where the whole of `cell` is none.
double decimalOrNan(std::string_view cell, DecimalSign sign);

/// The same; throws InputError, with what was seen, where it is none.
double decimal(std::string_view cell, DecimalSign sign, const std::string& file, std::size_t line,
               const std::string& column);

/// Digits behind the decimal sign; -1 where the number has an exponent.
int decimalsOf(std::string_view cell);

/// Digits, one comma, digits: a decimal comma, or two cells.
bool looksLikeDecimalComma(std::string_view cell);

/// In small letters; letters beyond ASCII stay.
std::string lowered(std::string_view text);

}  // namespace stiffscope::interchange
