#pragma once

#include <vtkSmartPointer.h>

#include <functional>
#include <memory>

#include "render/image.h"
#include "render/vtk/canvas.h"

class vtkRenderer;

namespace stiffscope {

/// Throws std::invalid_argument, with the numbers, when `size` is below 480 x 320 or above 8000 a side.
void requireUsable(Size size);

/// Lets `paint` draw over all else in `layer`. What `paint` throws is kept for `rethrow`, because an
/// exception must not cross VTK's pipeline.
class Painting {
 public:
  Painting(vtkRenderer& layer, Size size, std::function<void(Canvas&)> paint);
  /// Throws what the painting threw.
  void rethrow() const;

 private:
  struct Outcome;
  std::shared_ptr<Outcome> outcome_;
};

/// A picture on white paper that `paint` draws. Throws what `paint`, requireUsable and renderOffscreen throw.
Image drawFlat(Size size, const std::function<void(Canvas&)>& paint);

}  // namespace stiffscope
