#pragma once

#include <string>
#include <vector>

#include "core/fleet/fleet.h"
#include "reports/report_content.h"

namespace stiffscope::page {

/// Most machines whose campaigns stand on the page one by one, those that need most; the tables beside it hold all.
inline constexpr std::size_t kMostMachinesShown = 200;

/// The fleet as one self-contained page: machines ranked by what they need, what is another and from when, control
/// charts
/// (`figures`), stiffness and accuracy by machine and date, and what was asked of how many. `id` goes into its foot.
std::string fleetPage(const fleet::Fleet& fleet, const std::vector<reports::Figure>& figures, const std::string& id);

}  // namespace stiffscope::page
