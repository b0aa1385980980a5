#pragma once

#include <filesystem>
#include <string>

#include "reports/page/report_page.h"

namespace stiffscope::app {

/// Writes pictures, tables (CSV), results.json and report.html into a folder that is made where it is absent; they
/// appear together. Pictures and tables that an earlier report there listed as its own (`files` of its results.json)
/// and that this one does not make are removed; nothing else is.
void writeReportFiles(const std::filesystem::path& folder, const reports::ReportContent& content, const page::ReportPage& page);

}  // namespace stiffscope::app
