#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/diagnosis.h"

// What diagnoses of loaded and of unloaded days have in common.

namespace stiffscope::reports {

std::string shrinkInterval(const diagnosis::Shrink& shrink);  ///< "0.712 to 0.745"

/// Tables of where the gap lies under a title; those of many rows are left to the JSON. Empty without any.
std::string whereText(const std::vector<diagnosis::WhereTable>& tables, const char* title);

}  // namespace stiffscope::reports
