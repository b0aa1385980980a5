#pragma once

#include <array>
#include <vector>

#include "core/calibration/unloaded_day.h"

namespace stiffscope::comparison {

/// One reading of a day: its posture, and its place in the day's order of readings.
struct Place {
  std::size_t posture = 0, reading = 0;
};

struct CommonReading {
  Place before, after;
};

/// What two days without a load have in common.
struct CommonReadings {
  std::array<std::vector<int>, 2> targets;  ///< reflectors of the same id, in each day's numbers
  std::vector<CommonReading> readings;  ///< of the same reflector in the same posture, in the order of the day before
  std::size_t postures = 0;
};

/// Postures correspond where the pose id is the same and no joint angle differs by more than MatchLimits says.
CommonReadings commonReadings(const calibration::UnloadedDay& before, const calibration::UnloadedDay& after);

}  // namespace stiffscope::comparison
