#pragma once

#include "core/diagnosis/linear_system.h"

namespace stiffscope::diagnosis {

/// Variance factors of the absolute positions (`state.position_slack`, `sweep_slack`), from what the largest
/// model, all effects at once within their bounds, leaves of them. Never below 1.
void findSlack(const GapInput& input, const GapData& data, GapState& state);

}  // namespace stiffscope::diagnosis
