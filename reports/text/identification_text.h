#pragma once

#include <string>
#include <vector>

#include "core/identification/identify.h"

namespace stiffscope {

/// The result of `identify` for a terminal.
std::string identificationText(const Campaign& campaign, const Identification& result,
                               const std::vector<Method>& methods);

/// `CP`, `PP`, `DPP`.
const char* shortName(Method method);

/// `Complete Pose`, `Partial Pose`, `Decoupled Partial Pose`.
const char* longName(Method method);

}  // namespace stiffscope
