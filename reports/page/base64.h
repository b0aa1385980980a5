#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace stiffscope::page {

/// Base64 (RFC 4648, section 4) with padding, no line breaks.
std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace stiffscope::page
