#pragma once

#include <string>
#include <vector>

#include "render/colours.h"
#include "render/image.h"

namespace stiffscope::render {

/// One colour of bars: a value per category.
struct BarSeries {
  std::string name;  ///< stands in the legend
  Colour colour;
  std::vector<double> values;  ///< one per category; one that is not finite leaves a gap
  std::vector<double> errors;  ///< half-length of each whisker, same unit; empty, or one per category (NaN: none)
};

/// Bars in groups, from a zero line up or down: the paper's Fig. 7 (displacement of P_wrist per posture,
/// without compensation and after each method) and Fig. 8. From 1 to 60 groups; crowded category labels turn
/// upright or thin out. In every text `x_{abc}` sets abc as a subscript.
struct GroupedBarChart {
  std::string title;
  std::string subtitle;
  std::string y_title;         ///< with its unit: "Displacement of P_{wrist} (mm)"
  std::string category_title;  ///< "Posture"
  std::vector<std::string> categories;
  std::vector<BarSeries> series;
};

/// Draws the chart. Throws std::invalid_argument when there is no category or series, when a series' length
/// is not that of the categories, or when `size` is too small; std::runtime_error when offscreen rendering is
/// not to be had.
Image render(const GroupedBarChart& chart, Size size = {1200, 700});

}  // namespace stiffscope::render
