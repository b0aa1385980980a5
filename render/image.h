#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stiffscope::render {

/// Width and height of a picture in pixels. Pictures are legible from 480 x 320; smaller ones are refused.
struct Size {
  int width = 1200;
  int height = 700;
};

/// A picture: rows from top to bottom, three bytes (red, green, blue) a pixel, no padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  /// The three bytes of the pixel `x` from the left, `y` from the top. Not checked.
  const std::uint8_t* at(int x, int y) const {
    return &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
  }
};

/// `image` as a PNG file in memory: 8-bit RGB, no time stamp or text chunk, so equal images give equal bytes.
/// Throws std::invalid_argument when the size and the number of bytes of `image` disagree, std::runtime_error
/// when libpng fails.
std::vector<std::uint8_t> encodePng(const Image& image);

}  // namespace stiffscope::render
