#pragma once

#include "render/dot_row_chart.h"

namespace stiffscope::render {

Image drawDotRows(const DotRowChart& chart, Size size);

}  // namespace stiffscope::render
