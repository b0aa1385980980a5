#include "render/window/shown_layers.h"

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <cstdint>
#include <stdexcept>
#include <utility>

#include "render/vtk/collect_errors.h"

namespace stiffscope {

void ShownLayers::forget() {
  if (!layers_) return;
  for (const auto& layer : layers_->renderers()) window_.RemoveRenderer(layer);
  layers_.reset();
}

void ShownLayers::show(const ArmScene& scene) {
  const int* size = window_.GetSize();
  if (size[0] < 240 || size[1] < 160) return;
  const CollectErrors vtk_messages;
  auto next = std::make_unique<ArmLayers>(scene, Surface{{size[0], size[1]}, 1});
  forget();
  layers_ = std::move(next);
  window_.SetNumberOfLayers(static_cast<int>(layers_->renderers().size()));
  int at = 0;
  for (const auto& layer : layers_->renderers()) {
    layer->SetLayer(at++);
    window_.AddRenderer(layer);
  }
  window_.Render();
  layers_->rethrow();
  vtk_messages.throwIfAny();
}

Image ShownLayers::picture() const {
  const int* size = window_.GetSize();
  Image image{size[0], size[1], {}};
  vtkNew<vtkUnsignedCharArray> pixels;
  const int front = 0;
  window_.GetPixelData(0, 0, image.width - 1, image.height - 1, front, pixels);
  const std::ptrdiff_t row = std::ptrdiff_t{3} * image.width;
  if (pixels->GetNumberOfValues() != row * image.height) {
    throw std::runtime_error("cannot draw pictures: no pixels came back from the window");
  }
  image.rgb.reserve(static_cast<std::size_t>(row * image.height));
  for (int y = image.height - 1; y >= 0; --y) {  // VTK's rows run from bottom to top
    const std::uint8_t* from = pixels->GetPointer(row * y);
    image.rgb.insert(image.rgb.end(), from, from + row);
  }
  return image;
}

}  // namespace stiffscope
