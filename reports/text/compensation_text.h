#pragma once

#include <string>
#include <vector>

#include "core/compensation/compensate.h"
#include "core/identification/identify.h"

namespace stiffscope::reports {

/// The result of `compensate` for a terminal, and under it what a reader must know, a sentence each.
std::string compensationText(const campaign::Campaign& campaign, identification::Method method,
                             const std::vector<compensation::CompensatedPosture>& postures,
                             const std::vector<std::string>& cautions);

}  // namespace stiffscope::reports
