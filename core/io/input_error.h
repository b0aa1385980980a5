#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace stiffscope::io {

/// Where in a user's file something is wrong. Parts that do not apply stay empty (line 0, column "").
struct InputPlace {
  std::string file;
  std::size_t line = 0;     ///< counted from 1, the header line included
  std::string column = {};  ///< a table's column name, or an XML attribute or element
};

/// `FILE:LINE: COLUMN: 'VALUE': FINDING`, with the parts that apply, always one line: every part is stripped
/// of control characters, and a long value is shortened. Errors and warnings about input are written with it.
std::string inputMessage(const InputPlace& place, std::string_view value, std::string_view finding);

/// The one error for bad input. what() is one line:
/// `FILE:LINE: COLUMN: 'VALUE': EXPECTATION`, with the parts that apply.
/// The value is shortened and stripped of control characters, so that the message stays one line.
class InputError : public std::runtime_error {
 public:
  InputError(InputPlace place, std::string value, std::string expectation);

  const InputPlace& place() const { return place_; }
  const std::string& value() const { return value_; }
  const std::string& expectation() const { return expectation_; }

 private:
  InputPlace place_;
  std::string value_;
  std::string expectation_;
};

/// Edits that turn `a` into `b`: insertions, deletions, replacements, and swaps of two neighbours, each
/// counting one (optimal string alignment distance); letter case does not count.
std::size_t editDistance(std::string_view a, std::string_view b);

/// The candidate that a person who wrote `word` most likely meant: the one with the fewest edits, the first
/// of equals; empty where even that differs in more than a third of the letters (at least one edit is
/// allowed).
std::string nearestName(std::string_view word, const std::vector<std::string>& candidates);

/// " (did you mean 'X'?)" with the nearest candidate, or nothing, to end a message with.
std::string nearestNameHint(std::string_view word, const std::vector<std::string>& candidates);

/// `text` as it can stand in a one-line message: control characters and bytes that are not UTF-8 become '?',
/// and what is longer than `longest` bytes is cut between characters and ends in "...".
std::string oneLine(std::string_view text, std::size_t longest);

/// `text` of several lines and of any length, all else as above.
std::string withoutControls(std::string_view text);

/// Place of the first byte that belongs to no UTF-8 character; npos where all of `text` is UTF-8.
std::size_t findNotUtf8(std::string_view text);

}  // namespace stiffscope::io
