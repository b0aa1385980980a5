#pragma once

#include "reports/json/json_document.h"
#include "reports/report_content.h"

namespace stiffscope::reports {

/// `results.json` of a report: the names of the files it wrote, per campaign what was done to the readings and the results
/// of `audit`, `frames` and `identify`, and what the double encoders avoid. The content has to live as long.
JsonDocument resultsJson(const ReportContent& content);

}  // namespace stiffscope::reports
