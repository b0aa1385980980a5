#pragma once

#include <functional>

#include "render/vtk/chart_frame.h"

namespace stiffscope {

/// What stands around values by category: header, legend, note, both axes.
struct CategoryFrame {
  std::string title, subtitle, note, y_title, category_title;
  const std::vector<std::string>& categories;
  std::vector<LegendEntry> legend;
  /// The axis for a plot about this many pixels high.
  std::function<YAxis(double height)> axis;
};

/// Draws the frame around what `draw` draws on the plot; grid lines lie under it.
void drawInCategoryFrame(Canvas& canvas, const CategoryFrame& frame,
                         const std::function<void(const Box& plot, const YAxis& axis)>& draw);

}  // namespace stiffscope
