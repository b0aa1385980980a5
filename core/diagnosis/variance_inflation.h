#pragma once

#include "core/diagnosis/linear_system.h"

namespace stiffscope::diagnosis {

/// Variance factors of the absolute positions (`state.position_inflation`, `sweep_inflation`), from what the largest
/// model, all effects at once within their bounds, leaves of them. Never below 1.
void estimateInflation(const SystemInput& input, const LinearSystem& data, SystemState& state);

}  // namespace stiffscope::diagnosis
