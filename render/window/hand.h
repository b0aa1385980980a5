#pragma once

#include "render/vtk/canvas.h"

namespace stiffscope {

/// What the mouse does to a window, out of its single events (those of vtkCommand).
class Hand {
 public:
  enum class Kind { Nothing, Turn, Shift, Zoom, Click };
  struct Motion {
    Kind kind = Kind::Nothing;
    double x = 0, y = 0;  ///< pixels moved, to the right and downwards; Click: where; Zoom: y is the factor
  };
  Motion take(unsigned long event, Spot pointer);

 private:
  Motion release(Kind of, Spot pointer);

  Kind drag_ = Kind::Nothing;
  Spot pressed_, last_;
  bool moved_ = false;
};

}  // namespace stiffscope
