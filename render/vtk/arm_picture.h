#pragma once

#include "render/arm_scene.h"

namespace stiffscope {

Image drawArmScene(const ArmScene& scene, Size size);

}  // namespace stiffscope
