#pragma once

#include <vector>

#include "core/fleet/fleet.h"
#include "reports/report_content.h"
#include "reports/stated_results.h"

namespace stiffscope::app {

/// Of two results side by side: stiffnesses with their intervals, and in each posture the deflection and what is left
/// of it; at most 60 postures. What the two do not both state is left out. Throws std::runtime_error when offscreen
/// rendering is not to be had.
std::vector<reports::Figure> statedCharts(const reports::StatedComparison& comparison);

/// Most series of dates that are drawn.
inline constexpr std::size_t kMostFleetCharts = 40;

/// The control charts, a picture a series of two dates and more, a panel a joint; those of the machines that need most
/// first. Throws std::runtime_error when offscreen rendering is not to be had.
std::vector<reports::Figure> fleetCharts(const fleet::Fleet& fleet);

}  // namespace stiffscope::app
