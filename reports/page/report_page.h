#pragma once

#include <string>
#include <vector>

#include "reports/csv/csv_table.h"
#include "reports/report_content.h"

namespace stiffscope::page {

/// The report as one HTML5 page that needs nothing beside it: pictures as data: URIs, style inside, and
/// a few lines of script that sort a table by a click on its header; without script all is there, unsorted. No network.
/// Well-formed as XML after its doctype. Every text of a campaign is escaped.
std::string reportPage(const reports::ReportContent& content);

/// The page, and every table on it.
struct ReportPage {
  std::string html;
  std::vector<reports::TableFile> tables;
};
ReportPage makeReportPage(const reports::ReportContent& content);

}  // namespace stiffscope::page
