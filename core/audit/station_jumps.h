#pragma once

#include "core/audit/station_motion.h"

namespace stiffscope {

/// When the station jumped that did so between round `round` of the nests and the one before, s: between two
/// postures, where the unloaded positions then fit the arm best, or at the interval's start or end; its middle
/// where the positions cannot say.
double jumpTime(const Campaign& campaign, const TrackerNoise& noise, StationMotion station, std::size_t round);

/// Tells a jump of the station between two rounds from drift, and says when it jumped.
///
/// Repeats of one state follow each other within seconds: had the station drifted steadily as far as the
/// nests say, they would show it; where they scatter less as they were read, it jumped. When: between two
/// postures, where the unloaded positions then best fit forward kinematics, or before the first or after the
/// last of the interval.
void findJumps(const Campaign& campaign, const TrackerNoise& noise, StationMotion& station);

}  // namespace stiffscope
