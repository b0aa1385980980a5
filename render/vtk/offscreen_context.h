#pragma once

#include <vtkSmartPointer.h>

#include <vector>

#include "render/image.h"

class vtkRenderer;

namespace stiffscope {

/// How many rendered pixels a pixel of the picture is averaged from, in each direction: the antialiasing.
inline constexpr int kSupersampling = 2;

/// Renders `layers`, the first at the back, into a picture of `size` without display or GPU, at
/// kSupersampling times the size, averaged down. One software GL context serves all pictures of the process;
/// calls from several threads wait for each other. Throws std::runtime_error with the reason when there is no
/// context or VTK reports an error.
Image renderOffscreen(const std::vector<vtkSmartPointer<vtkRenderer>>& layers, Size size);

}  // namespace stiffscope
