#pragma once

#include <string>
#include <vector>

#include "core/compensation/compensate.h"
#include "core/identification/identify.h"

namespace stiffscope {

/// The result of `compensate` for a terminal.
std::string compensationText(const Campaign& campaign, Method method, const std::vector<CompensatedPosture>& postures);

}  // namespace stiffscope
