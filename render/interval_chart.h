#pragma once

#include <limits>
#include <string>
#include <vector>

#include "render/colours.h"
#include "render/image.h"

namespace stiffscope::render {

/// A value and the ends of its interval, in the unit of the axis; an infinite end has none. A value that is not finite
/// leaves a gap. Of a value that has no place on the axis (see IntervalChart) the interval need not hold it: what is
/// possible may lie apart from what was found.
struct Interval {
  double value = std::numeric_limits<double>::quiet_NaN();
  double lower = std::numeric_limits<double>::quiet_NaN();
  double upper = std::numeric_limits<double>::quiet_NaN();
  bool doubtful = false;  ///< drawn hollow: imprecise, unphysical or otherwise to be read with its remark
};

/// A method: one point with whisker per category.
struct IntervalSeries {
  std::string name;
  Colour colour;
  std::vector<Interval> intervals;  ///< one per category
};

/// Points with whiskers by category (joint) and series (method), on a linear or logarithmic axis.
/// On a logarithmic axis a value that is not positive has no place: an arrow at the lower edge stands for it,
/// as it does for the end of a whisker that reaches zero; a note under the picture says so. In every text
/// `x_{abc}` sets abc as a subscript.
struct IntervalChart {
  std::string title;
  std::string subtitle;
  std::string y_title;         ///< with its unit
  std::string category_title;  ///< "Joint"
  std::vector<std::string> categories;
  std::vector<IntervalSeries> series;
  bool logarithmic = false;
  std::vector<double> references;  ///< empty, or a dashed line per category (NaN: none), such as the true value
  std::string reference_name;      ///< of those lines, in the legend
  std::string doubtful_name;       ///< what a hollow point means, in the legend; empty: not said
};

/// Draws the chart. Throws std::invalid_argument when there is no category or series, when lengths disagree
/// or an interval's ends do not enclose a value that has a place on the axis, or when `size` is too small;
/// std::runtime_error when offscreen rendering is not to be had.
Image render(const IntervalChart& chart, Size size = {1200, 700});

}  // namespace stiffscope::render
