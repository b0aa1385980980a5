#pragma once

#include <functional>
#include <memory>

#include "render/vtk/canvas.h"

class vtkRenderer;

namespace stiffscope {

/// Lets `paint` draw over all else in `layer`, each time that is rendered. What `paint` throws is kept for
/// `rethrow`, because an exception must not cross VTK's pipeline.
class Painting {
 public:
  Painting(vtkRenderer& layer, const Surface& surface, std::function<void(Canvas&)> paint);
  /// Throws what the painting threw.
  void rethrow() const;

 private:
  struct Outcome;
  std::shared_ptr<Outcome> outcome_;
};

}  // namespace stiffscope
