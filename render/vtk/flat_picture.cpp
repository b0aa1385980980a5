#include "render/vtk/flat_picture.h"

#include <fmt/format.h>
#include <vtkRenderer.h>

#include <stdexcept>

#include "render/vtk/offscreen_context.h"
#include "render/vtk/painting.h"

namespace stiffscope {

void requireUsable(Size size) {
  if (size.width < 480 || size.height < 320 || size.width > 8000 || size.height > 8000) {
    throw std::invalid_argument(fmt::format("a picture of {} x {} pixels: expected 480 x 320 to 8000 x 8000",
                                            size.width, size.height));
  }
}

Image drawFlat(Size size, const std::function<void(Canvas&)>& paint) {
  requireUsable(size);
  const auto layer = vtkSmartPointer<vtkRenderer>::New();
  layer->SetBackground(1, 1, 1);
  const Painting painting(*layer, {size}, paint);
  Image image = renderOffscreen({layer}, size);
  painting.rethrow();
  return image;
}

}  // namespace stiffscope
