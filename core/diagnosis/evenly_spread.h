#pragma once

#include "core/campaign/campaign.h"

namespace stiffscope {

/// A posture costs the diagnosis about a megabyte of equations and one more fit without it: of a longer day it looks at
/// so many postures.
inline constexpr std::size_t kMostDiagnosed = 100;

/// The campaign with at most so many of its postures, spread evenly over the day.
Campaign evenlySpread(const Campaign& campaign, std::size_t most);

}  // namespace stiffscope
