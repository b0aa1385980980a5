#pragma once

#include <filesystem>
#include <string>

#include "reports/page/report_content.h"

namespace stiffscope {

/// Writes pictures, results.json and, last, report.html into a folder that is made where it is absent.
/// Pictures that an earlier report there listed as its own (`files` of its results.json) and that this one
/// does not make are removed; nothing else is.
void writeReportFiles(const std::filesystem::path& folder, const ReportContent& content,
                      const std::string& page, const std::string& results);

}  // namespace stiffscope
