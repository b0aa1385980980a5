#pragma once

#include "render/interval_chart.h"

namespace stiffscope::render {

Image drawIntervals(const IntervalChart& chart, Size size);

}  // namespace stiffscope::render
