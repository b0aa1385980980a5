#pragma once

#include "reports/json/campaign_json.h"
#include "reports/page/report_content.h"

namespace stiffscope {

/// `results.json` of a report: per campaign the results of `frames` and `identify`, and what the double encoders avoid.
Json resultsJson(const ReportContent& content);

}  // namespace stiffscope
