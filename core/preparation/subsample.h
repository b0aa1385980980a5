#pragma once

#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope::preparation {

/// A posture costs the diagnosis about a megabyte of equations and one more fit without it: of a longer day it looks at
/// so many postures. A reading of a sweep costs 13 kB, so of a longer table it looks at so many.
inline constexpr std::size_t kMostDiagnosed = 100, kMostSwept = 2000;

/// Of `count` things at most `most`, spread evenly over them: their indices, ascending.
std::vector<std::size_t> evenlySpreadIndices(std::size_t count, std::size_t most);

/// Of the campaign's postures at most `most`, ascending: those with readings unloaded and under load first, spread
/// evenly over them, since the others show no deflection; where there are fewer than `most` of these, others spread
/// evenly besides.
std::vector<std::size_t> spreadPostures(const campaign::Campaign& campaign, std::size_t most);

/// The campaign of `spreadPostures` alone, numbered anew in their order, and of each sweep `most_swept` readings, as
/// many of each axis and reflector, spread evenly. The other readings are never copied.
campaign::Campaign evenlySpread(const campaign::Campaign& campaign, std::size_t most,
                                std::size_t most_swept = kMostSwept);

/// Whether evenlySpread of that many would leave sweep readings out.
bool hasLongSweep(const campaign::Campaign& campaign, std::size_t most_swept = kMostSwept);

}  // namespace stiffscope::preparation
