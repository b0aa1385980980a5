#include "app/commands/compare_results.h"

#include "app/figures/stated_charts.h"
#include "core/io/write_file.h"
#include "reports/json/json.h"
#include "reports/page/comparison_page.h"
#include "reports/stated_results.h"
#include "reports/text/text.h"

namespace stiffscope::app {

int compareResults(const std::string& before, const std::string& after, const std::string& html, const Outlet& outlet) {
  const reports::StatedComparison comparison =
      reports::compareStated(reports::readStatedCampaign(before), reports::readStatedCampaign(after));
  if (comparison.refused.empty() && !html.empty())
    io::writeFileWhole(html, page::comparisonPage(comparison, statedCharts(comparison)));
  outlet.deliver([&] { return reports::statedComparisonJson(comparison); },
                 [&] { return reports::statedComparisonText(comparison); });
  return comparison.refused.empty() ? kDone : kNotUsable;
}

}  // namespace stiffscope::app
