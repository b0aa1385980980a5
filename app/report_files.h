#pragma once

#include <filesystem>
#include <string>

#include "reports/json/json_values.h"
#include "reports/page/report_content.h"
#include "reports/page/report_page.h"

namespace stiffscope {

/// Writes pictures, the page's tables (tables/NAME.csv, listed in `files` of the results too), results.json and,
/// last, report.html into a folder that is made where it is absent. Pictures and tables that an earlier report there listed as its own (`files` of its results.json) and that this one
/// does not make are removed; nothing else is.
void writeReportFiles(const std::filesystem::path& folder, const ReportContent& content,
                      const ReportPage& page, Json results);

}  // namespace stiffscope
