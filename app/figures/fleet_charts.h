#pragma once

#include <vector>

#include "core/fleet/fleet.h"
#include "reports/report_content.h"

namespace stiffscope::app {

/// Most series of dates that are drawn.
inline constexpr std::size_t kMostFleetCharts = 40;

/// The control charts, a picture a series of two dates and more, a panel a joint; those of the machines that need most
/// first. Throws std::runtime_error when offscreen rendering is not to be had.
std::vector<reports::Figure> fleetCharts(const fleet::Fleet& fleet);

}  // namespace stiffscope::app
