#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace stiffscope {

/// Where in a user's file something is wrong. Parts that do not apply stay empty (line 0, column "").
struct InputPlace {
  std::string file;
  std::size_t line = 0;  ///< counted from 1, the header line included
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

}  // namespace stiffscope
