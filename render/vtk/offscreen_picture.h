#pragma once

#include <functional>

#include "render/arm_scene.h"
#include "render/image.h"
#include "render/vtk/canvas.h"

namespace stiffscope::render {

Image drawArmScene(const ArmScene& scene, Size size);

/// Throws std::invalid_argument, with the numbers, when `size` is below 480 x 320 or above 8000 a side.
void requireUsable(Size size);

/// A picture on white paper that `paint` draws. Throws what `paint`, requireUsable and renderOffscreen throw.
Image drawFlat(Size size, const std::function<void(Canvas&)>& paint);

}  // namespace stiffscope::render
