#pragma once

#include <string>
#include <vector>

#include "reports/report_content.h"

namespace stiffscope::page {

/// A number of the first screen and what it is, a clause; rich texts.
struct KeyNumber {
  std::string value, words;
};

/// The numbers of the first screen, of the campaign that leads: of loads the deflection, what is compensated of it, and
/// what double encoders avoid or how many stiffnesses were found; of sweeps alone axes and distances; of a day without
/// a load its position errors.
std::vector<KeyNumber> keyNumbers(const reports::ReportContent& content);

}  // namespace stiffscope::page
