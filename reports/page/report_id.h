#pragma once

#include <string>

#include "reports/page/report_content.h"

namespace stiffscope {

/// What a report is known by: twelve hex digits of the SHA-256 of the names and hashes of all files read, of
/// the settings, the version of the program and whether the paper stands beside. The same input gives the same
/// id, on any day and any machine: "4f2a-91c0-77de".
std::string reportId(const ReportContent& content);

}  // namespace stiffscope
