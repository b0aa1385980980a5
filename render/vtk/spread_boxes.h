#pragma once

#include "render/spread_chart.h"

namespace stiffscope::render {

Image drawSpreads(const SpreadChart& chart, Size size);

}  // namespace stiffscope::render
