#pragma once

#include "render/grouped_bar_chart.h"
#include "reports/page/avoided_by_encoders.h"
#include "reports/page/figure.h"

namespace stiffscope {

/// |displacement| per posture with the double encoders inactive and active, mm. Of an available one.
GroupedBarChart encoderBars(const AvoidedByEncoders& avoided);

Figure describeEncoderBars(const AvoidedByEncoders& avoided);

}  // namespace stiffscope
