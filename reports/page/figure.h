#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace stiffscope {

/// A finished picture with its words. In title and caption `x_{abc}` sets abc as a subscript; `alt` is plain.
struct Figure {
  std::string
      id;  ///< unique in a report; letters, digits and hyphens: an anchor, and a file's name without ".png"
  std::string title;
  std::string caption;  ///< what to see in it, with the number
  std::string alt;      ///< what the picture shows, for those who do not see it
  std::vector<std::uint8_t> png;
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
};

/// The name of its file in a report's folder.
inline std::string pictureFile(const Figure& figure) { return figure.id + ".png"; }

}  // namespace stiffscope
