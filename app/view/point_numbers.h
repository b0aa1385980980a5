#pragma once

#include <string>

#include "app/view/view_material.h"

namespace stiffscope {

/// The displacements of one point by coordinate of R0, mm, and the load: for the panel beside the scene.
ScenePanel pointPanel(const ViewFrame& frame, const ScenePoint& point, bool dark);

/// The same as text, and with the posture: for standard output.
std::string pointText(const ViewFrame& frame, const ScenePoint& point);

}  // namespace stiffscope
