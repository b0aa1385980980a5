#pragma once

#include <cstddef>
#include <string_view>

namespace stiffscope {

/// Bytes of the UTF-8 character (RFC 3629) that starts `text`, 1 to 4; 0 where `text` is empty or starts with
/// none.
std::size_t utf8CharacterLength(std::string_view text);

/// Place of the first byte that belongs to no UTF-8 character; npos where all of `text` is UTF-8.
std::size_t findNotUtf8(std::string_view text);

}  // namespace stiffscope
