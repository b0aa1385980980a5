#pragma once

#include "core/cartesian_stiffness/posture_stiffness.h"
#include "reports/json/json_values.h"

namespace stiffscope {

/// A posture's conditioning and Cartesian stiffness at P_TCP, R0 axes; the principal stiffnesses are those with
/// K_c.
Json postureStiffnessJson(const PostureStiffness& posture);

}  // namespace stiffscope
