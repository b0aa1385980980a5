#pragma once

#include <vector>

#include "core/cartesian_stiffness/posture_stiffness.h"
#include "reports/json/json_values.h"

namespace stiffscope {

/// Rows of conditioning and Cartesian stiffness at P_TCP, R0 axes; the principal stiffnesses are those with
/// K_c.
Json postureStiffnessJson(const std::vector<PostureStiffness>& postures);

}  // namespace stiffscope
