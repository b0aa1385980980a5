#pragma once

#include "core/diagnosis/gap_data.h"

namespace stiffscope {

/// Adds to the equations what is known before the gap is looked at: how far geometry steps and own weights
/// may go in one round, the six compliances as expected, a drift as the nests have it.
void addKnownBeforehand(const GapInput& input, GapData& data);

}  // namespace stiffscope
