#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace stiffscope::render {

/// Width and height of a picture in pixels. Pictures are legible from 480 x 320; smaller ones are refused.
struct Size {
  int width = 1200;
  int height = 700;
  /// Two pixels instead of each in both directions, for print and dense screens: the picture as it is rendered anyway,
  /// not averaged down.
  bool doubled = false;
  /// Letters, lines and dots this many times as large: for a picture that is shown smaller than it is.
  double letters = 1;
};

/// Where something stands that has a value: a bar's end, a point, a box. For what is laid over a picture.
struct Mark {
  double x = 0, y = 0;     ///< shares of the picture's width from the left, of its height from the top
  std::string series;      ///< as in the legend; a rich text
  std::string category;    ///< the posture, the joint, the row; empty where the axis is one of numbers
  double value = 0;        ///< in the unit of the axis
  double category_at = 0;  ///< where there is no category: on the horizontal axis
  std::string quantity{};  ///< title of the axis that the value stands on, where panels have axes of their own
};

/// A picture: rows from top to bottom, three bytes (red, green, blue) a pixel, no padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  std::vector<Mark> marks;  ///< of a chart in the order in which they are drawn; of a scene its points, without values

  /// The three bytes of the pixel `x` from the left, `y` from the top. Not checked.
  const std::uint8_t* at(int x, int y) const {
    return &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
  }
};

/// `image` as a PNG file in memory: 8-bit RGB, no time stamp or text chunk, so equal images give equal bytes.
/// Throws std::invalid_argument when the size and the number of bytes of `image` disagree, std::runtime_error
/// when libpng or libdeflate fails.
std::vector<std::uint8_t> encodePng(const Image& image);

/// The same in 256 colours at most, a third as large and as long to make: for pictures of which a page carries dozens.
/// Flat colours stay exact; of shades and of the edges of letters neighbours become one, a few of 255 steps apart.
std::vector<std::uint8_t> encodeSmallPng(const Image& image);

}  // namespace stiffscope::render
