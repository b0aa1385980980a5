#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace stiffscope {

/// `text` as it can stand in a one-line message: control characters and bytes that are not UTF-8 become '?',
/// and what is longer than `longest` bytes is cut between characters and ends in "...".
std::string oneLine(std::string_view text, std::size_t longest);

/// `text` of several lines and of any length, all else as above.
std::string withoutControls(std::string_view text);

}  // namespace stiffscope
