#pragma once

#include <vtkSmartPointer.h>

#include <vector>

#include "render/image.h"
#include "render/vtk/canvas.h"

class vtkRenderer;

namespace stiffscope {

/// Renders `layers`, the first at the back, into a picture of `size` without display or GPU, at
/// kSupersampling times the size, averaged down. One software GL context serves all pictures of the process;
/// calls from several threads wait for each other. Throws std::runtime_error with the reason when there is no
/// context or VTK reports an error.
Image renderOffscreen(const std::vector<vtkSmartPointer<vtkRenderer>>& layers, Size size);

}  // namespace stiffscope
