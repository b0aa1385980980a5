#pragma once

#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope {

/// A posture costs the diagnosis about a megabyte of equations and one more fit without it: of a longer day it looks at
/// so many postures.
inline constexpr std::size_t kMostDiagnosed = 100;

/// At most `most` of a day's postures, spread evenly over it: their indices, ascending.
std::vector<int> evenlySpreadPostures(std::size_t postures, std::size_t most);

/// The campaign of those postures alone, numbered anew in their order. The other readings are never copied.
Campaign evenlySpread(const Campaign& campaign, std::size_t most);

}  // namespace stiffscope
