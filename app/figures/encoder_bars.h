#pragma once

#include "render/grouped_bar_chart.h"
#include "reports/page/avoided_share.h"
#include "reports/page/figure.h"

namespace stiffscope {

/// |displacement| per posture with the double encoders inactive and active, mm.
GroupedBarChart encoderBars(const AvoidedShare& avoided);

Figure describeEncoderBars(const AvoidedShare& avoided);

}  // namespace stiffscope
