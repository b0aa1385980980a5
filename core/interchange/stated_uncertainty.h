#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/interchange/day_files.h"

namespace stiffscope::interchange {

/// The standard uncertainties that files of points state.
struct StatedUncertainty {
  double sigma = 0.0;                   ///< m, median over the readings of the rms of x, y, z
  std::optional<double> over_declared;  ///< the same over the noise declared of the tracker, median; where it is
  std::size_t compared = 0;             ///< readings that were compared with it
};

/// nullopt where no file states any.
std::optional<StatedUncertainty> statedUncertainty(const std::vector<DayFiles::Points>& files,
                                                   const std::optional<campaign::Tracker>& tracker);

/// The warning of uncertainties more than a factor of 2 from the declared noise; `file` is DAY.xml.
std::optional<std::string> warningOf(const StatedUncertainty& stated, const std::string& file);

}  // namespace stiffscope::interchange
