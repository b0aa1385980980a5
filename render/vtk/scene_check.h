#pragma once

#include "render/arm_scene.h"

namespace stiffscope {

/// Throws std::invalid_argument, as arm_scene.h says, with the offending numbers.
void requireDrawable(const ArmScene& scene);

}  // namespace stiffscope
