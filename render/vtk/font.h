#pragma once

#include <string>

namespace stiffscope {

/// The font files of all pictures: DejaVu Sans, which has Greek letters and subscript digits.
struct Fonts {
  std::string regular;
  std::string bold;
};

/// Looks in the folder that the environment variable STIFFSCOPE_FONTS names and nowhere else, or else in the
/// one found when this was built, then in those where Linux distributions put DejaVu. Throws
/// std::runtime_error that names the folders looked in.
Fonts findFonts();

}  // namespace stiffscope
