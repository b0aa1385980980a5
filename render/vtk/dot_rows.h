#pragma once

#include "render/dot_row_chart.h"

namespace stiffscope {

Image drawDotRows(const DotRowChart& chart, Size size);

}  // namespace stiffscope
