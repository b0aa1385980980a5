#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace stiffscope {

/// The line of a text, counted from 1, that the byte at `at` is in.
inline std::size_t lineOf(std::string_view bytes, std::size_t at) {
  const auto before = bytes.substr(0, at);
  return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

}  // namespace stiffscope
