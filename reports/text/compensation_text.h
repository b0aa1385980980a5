#pragma once

#include <string>
#include <vector>

#include "core/compensation/compensate.h"
#include "core/identification/identify.h"

namespace stiffscope {

/// The result of `compensate` for a terminal, and under it what a reader must know, a sentence each.
std::string compensationText(const Campaign& campaign, Method method,
                             const std::vector<CompensatedPosture>& postures,
                             const std::vector<std::string>& cautions);

}  // namespace stiffscope
