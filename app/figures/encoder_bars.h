#pragma once

#include "render/grouped_bar_chart.h"
#include "reports/page/avoided.h"
#include "reports/page/figure.h"

namespace stiffscope {

/// |displacement| per posture with the double encoders inactive and active, mm.
GroupedBarChart encoderBars(const AvoidedDeflection& avoided);

Figure describeEncoderBars(const AvoidedDeflection& avoided);

}  // namespace stiffscope
