#pragma once

#include <string>

#include "core/comparison/compare_campaigns.h"

namespace stiffscope {

/// The result of `compare` for a terminal.
std::string comparisonText(const Campaign& before, const Campaign& after, const Comparison& comparison);

}  // namespace stiffscope
