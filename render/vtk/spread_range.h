#pragma once

#include <string>
#include <vector>

#include "render/spread_chart.h"

namespace stiffscope {

struct ValueRange {
  double lower = 0;
  double upper = 1;
};

/// Throws std::invalid_argument, as spread_chart.h says, with the offending numbers.
void requireConsistent(const SpreadChart& chart);
/// What the axis of `panel` covers, by the rule of spread_chart.h.
ValueRange rangeOf(const SpreadPanel& panel);
/// What the boxes are, and, where something was cut off, what the arrows mean.
std::string noteOn(const SpreadChart& chart, const std::vector<ValueRange>& ranges);

}  // namespace stiffscope
