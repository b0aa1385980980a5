#pragma once

#include <string>
#include <vector>

#include "core/fleet/fleet.h"
#include "core/validation/run_blind.h"
#include "reports/csv/csv_table.h"
#include "reports/report_content.h"
#include "reports/stated_results.h"

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

/// Most machines whose campaigns stand on the page one by one, those that need most; the tables beside it hold all.
inline constexpr std::size_t kMostMachinesShown = 200;

/// The fleet as one self-contained page: machines ranked by what they need, what is another and from when, control
/// charts (`figures`), stiffness and accuracy by machine and date, and what was asked of how many. `id` goes into its
/// foot.
std::string fleetPage(const fleet::Fleet& fleet, const std::vector<reports::Figure>& figures, const std::string& id);

/// Two results side by side as one self-contained page. Throws std::invalid_argument where they are refused.
std::string comparisonPage(const reports::StatedComparison& comparison, const std::vector<reports::Figure>& figures);

/// The blind test as one self-contained page: what was done, the seal, the rates, accuracy against size, the
/// confusion matrix, effects one by one, the promised shrink against the true one.
std::string blindPage(const validation::BlindOptions& options, const validation::BlindResult& result);

}  // namespace stiffscope::page
