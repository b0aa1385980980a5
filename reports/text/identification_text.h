#pragma once

#include <string>
#include <vector>

#include "core/identification/identify.h"

namespace stiffscope {

/// The result of `identify` for a terminal.
std::string identificationText(const Campaign& campaign, const Identification& result,
                               const std::vector<Method>& methods);

}  // namespace stiffscope
