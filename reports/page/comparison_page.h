#pragma once

#include <string>
#include <vector>

#include "reports/report_content.h"
#include "reports/stated_results.h"

namespace stiffscope::page {

/// Two results side by side as one self-contained page. Throws std::invalid_argument where they are refused.
std::string comparisonPage(const reports::StatedComparison& comparison, const std::vector<reports::Figure>& figures);

}  // namespace stiffscope::page
