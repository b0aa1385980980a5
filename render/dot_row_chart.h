#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "render/image.h"

namespace stiffscope::render {

/// A row: a name at the left, a size on the axis.
struct DotRow {
  std::string name;
  double size = std::numeric_limits<double>::quiet_NaN();  ///< positive, in the unit of the axis; else no dot
  std::string words;                                       ///< in place of the dot where there is none
  bool marked = false;                                     ///< bold, with a diamond: what the picture is about
};

/// Rows with a size each on a logarithmic axis, and beside their names a column for each group: a line that
/// joins the dots of the rows that belong together, pale dots where the others are. In every text `x_{abc}`
/// sets abc as a subscript.
struct DotRowChart {
  std::string title;
  std::string subtitle;
  std::string x_title;  ///< with its unit
  std::vector<DotRow> rows;
  std::vector<std::vector<std::size_t>> groups;  ///< indices of rows; at most 12 are drawn, the note says of more
  std::string group_title;                       ///< over the columns: "cannot be told apart"
  std::string dot_name, marked_name;             ///< in the legend; empty: not said
  double reference = std::numeric_limits<double>::quiet_NaN();  ///< a dashed line at this size
  std::string reference_name;
};

/// Draws the chart. Throws std::invalid_argument when there is no row, when a group names a row that there is
/// not or fewer than two, or when `size` is too small; std::runtime_error when offscreen rendering is not to
/// be had.
Image render(const DotRowChart& chart, Size size = {1200, 700});

}  // namespace stiffscope::render
