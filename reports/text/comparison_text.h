#pragma once

#include <string>

#include "core/comparison/compare.h"

namespace stiffscope::reports {

/// The result of `compare` for a terminal.
std::string comparisonText(const campaign::Campaign& before, const campaign::Campaign& after, const comparison::Comparison& comparison);

}  // namespace stiffscope::reports
