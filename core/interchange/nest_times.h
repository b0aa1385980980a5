#pragma once

#include <cstddef>
#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope::interchange {

/// Readings of a nest that were moved in time.
struct MovedNests {
  std::size_t count = 0;
  std::size_t first = 0;    ///< row of the first of them
  double farthest_s = 0.0;  ///< by so much at most
};

/// Keeps readings of one nest at one time apart, as a table of nests has each time of a nest once, with four decimals:
/// later ones are moved on, in their order, by less than the last digit of the clock, but by one of the table where the
/// clock's is finer or so many share a time. `resolutions` are the last digits of the rows' times, s.
MovedNests keepTimesApart(std::vector<campaign::NestReading>& rows, const std::vector<double>& resolutions);

}  // namespace stiffscope::interchange
