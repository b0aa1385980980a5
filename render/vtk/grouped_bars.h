#pragma once

#include "render/grouped_bar_chart.h"

namespace stiffscope::render {

Image drawGroupedBars(const GroupedBarChart& chart, Size size);

}  // namespace stiffscope::render
