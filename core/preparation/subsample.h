#pragma once

#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope::preparation {

/// A posture costs the diagnosis about a megabyte of equations and one more fit without it: of a longer day it looks at
/// so many postures. A reading of a sweep costs 13 kB, so of a longer table it looks at so many.
inline constexpr std::size_t kMostDiagnosed = 100, kMostSwept = 2000;

/// A reflector brings the diagnosis 25 unknowns, three of its place and 22 of its motion in the nest, and what a dozen
/// of them on one flange do not show, a hundred do not either: of more it looks at so many.
inline constexpr std::size_t kMostReflectors = 12;

/// A mean over postures, or what all of a longer day settle afterwards, is taken of so many.
inline constexpr std::size_t kMostAveraged = 1000;

/// Of `count` things at most `most`, spread evenly over them: their indices, ascending.
std::vector<std::size_t> evenlySpreadIndices(std::size_t count, std::size_t most);

/// Of the campaign's postures at most `most`, ascending: those with readings unloaded and under load first, spread
/// evenly over them, since the others show no deflection; where there are fewer than `most` of these, others spread
/// evenly besides. `steps`: under one of these loads; of none given, under any.
std::vector<std::size_t> spreadPostures(const campaign::Campaign& campaign, std::size_t most,
                                        const std::vector<int>& steps = {});

/// The campaign of these postures alone, ascending, numbered anew in their order, and of each sweep `most_swept`
/// readings, as many of each axis and reflector, spread evenly. The other readings are never copied.
campaign::Campaign ofPostures(const campaign::Campaign& campaign, const std::vector<std::size_t>& postures,
                              std::size_t most_swept = kMostSwept);

/// That of `spreadPostures`.
campaign::Campaign evenlySpread(const campaign::Campaign& campaign, std::size_t most,
                                std::size_t most_swept = kMostSwept, const std::vector<int>& steps = {});

/// How many of the campaign's reflectors, from the first in its list, take part where there are more than `most`: until
/// so many were read in the loading, unloaded or under load. All of them where there are not.
std::size_t firstReflectors(const campaign::Campaign& campaign, std::size_t most);

/// The campaign of these alone; what is left keeps its numbers.
campaign::Campaign ofFirstReflectors(campaign::Campaign campaign, std::size_t most);

/// Whether evenlySpread of that many would leave sweep readings out.
bool hasLongSweep(const campaign::Campaign& campaign, std::size_t most_swept = kMostSwept);

}  // namespace stiffscope::preparation
