#pragma once

#include <string>
#include <string_view>

namespace stiffscope {

/// SHA-256 (FIPS 180-4) of `bytes`, 64 lower-case hex digits. Throws std::runtime_error where the system's
/// libcrypto refuses to compute it.
std::string sha256Hex(std::string_view bytes);

}  // namespace stiffscope
