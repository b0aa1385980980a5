#pragma once

#include <array>
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
  std::string section = "figures";  ///< id of the section of the page that it stands in; see kFigureSections
};

/// The sections that have figures, in the order of the page: figures are counted in it.
inline constexpr std::array kFigureSections{"wrist", "links", "stiffness", "subsets", "compensation",
                                            "gap",   "figures", "audit"};

/// The name of its file in a report's folder.
inline std::string pictureFile(const Figure& figure) { return figure.id + ".png"; }

}  // namespace stiffscope
