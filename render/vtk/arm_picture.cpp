#include "render/vtk/arm_picture.h"

#include "render/vtk/arm_layers.h"
#include "render/vtk/flat_picture.h"
#include "render/vtk/offscreen_context.h"

namespace stiffscope {

Image drawArmScene(const ArmScene& scene, Size size) {
  requireUsable(size);
  const ArmLayers layers(scene, {size});
  Image image = renderOffscreen(layers.renderers(), size);
  layers.rethrow();
  return image;
}

}  // namespace stiffscope
