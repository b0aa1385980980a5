#pragma once

#include "render/grouped_bar_chart.h"
#include "core/identification/avoided.h"
#include "reports/page/figure.h"

namespace stiffscope {

/// |displacement| per posture with the double encoders inactive and active, mm. Of an available one.
GroupedBarChart encoderBars(const AvoidedDeflection& avoided);

Figure describeEncoderBars(const AvoidedDeflection& avoided);

}  // namespace stiffscope
