#pragma once

#include <cstdint>
#include <vector>

#include "render/image.h"

namespace stiffscope {

/// `image` as a PNG file in memory: 8-bit RGB, no time stamp or text chunk, so equal images give equal bytes.
/// Throws std::invalid_argument when the size and the number of bytes of `image` disagree, std::runtime_error
/// when libpng fails.
std::vector<std::uint8_t> encodePng(const Image& image);

}  // namespace stiffscope
