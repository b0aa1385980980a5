#pragma once

#include "render/dot_row_chart.h"
#include "render/grouped_bar_chart.h"
#include "render/interval_chart.h"
#include "render/point_chart.h"
#include "render/spread_chart.h"

// The charts, each painted as large as it is asked for.

namespace stiffscope::render {

Image drawGroupedBars(const GroupedBarChart& chart, Size size);
Image drawSpreads(const SpreadChart& chart, Size size);
Image drawIntervals(const IntervalChart& chart, Size size);
Image drawPoints(const PointChart& chart, Size size);
Image drawDotRows(const DotRowChart& chart, Size size);

}  // namespace stiffscope::render
