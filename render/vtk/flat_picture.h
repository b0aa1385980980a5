#pragma once

#include <functional>

#include "render/image.h"
#include "render/vtk/canvas.h"

namespace stiffscope {

/// Throws std::invalid_argument, with the numbers, when `size` is below 480 x 320 or above 8000 a side.
void requireUsable(Size size);

/// A picture on white paper that `paint` draws. Throws what `paint`, requireUsable and renderOffscreen throw.
Image drawFlat(Size size, const std::function<void(Canvas&)>& paint);

}  // namespace stiffscope
