#pragma once

#include "render/grouped_bar_chart.h"

namespace stiffscope {

Image drawGroupedBars(const GroupedBarChart& chart, Size size);

}  // namespace stiffscope
