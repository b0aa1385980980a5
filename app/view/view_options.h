#pragma once

#include <optional>
#include <string>

#include "render/arm_scene.h"

namespace stiffscope {

/// The command line of stiffscope-view.
struct ViewOptions {
  std::string campaign;
  std::string method;  ///< empty: the one that the report shows
  std::optional<int> step;
  std::string pose;  ///< empty: the one with the median displacement
  std::optional<double> magnification;
  View view = View::Oblique;
  bool dark = false;
  Size size{1280, 860};
  std::string screenshot;  ///< empty: interactive
  std::string point;       ///< the point whose numbers are shown
};

}  // namespace stiffscope
