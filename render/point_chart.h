#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/colours.h"
#include "render/image.h"

namespace stiffscope::render {

struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
};

enum class PointMark { disc, ring, diamond, square, none };

/// What a point says to a pointer.
struct PointValue {
  double value = 0.0;
  double at = 0.0;         ///< on the axis of numbers that it belongs to
  std::string category{};  ///< instead of that: the posture, say
};

/// Points of one kind. A point that is not finite is left out, and breaks the line.
struct PointSeries {
  std::string name;  ///< in the legend; what has the same name in several panels stands there once; empty: not
  Colour colour;
  PointMark mark = PointMark::disc;
  bool joined = false;  ///< a line from each point to the next
  std::vector<PlotPoint> points;
  std::vector<PlotPoint> line = {};  ///< of a shape: under the points, where what joins them is not straight
  std::vector<double> errors;        ///< half-length of each whisker along y; empty, or one a point (0: none)
  /// Empty, or one a point. Points of a diagram say their y without; those of a shape, and lines without marks,
  /// nothing.
  std::vector<PointValue> values = {};
};

/// One diagram. `categories` name the places x = 0, 1, 2, ...; without them x is a number.
struct PointPanel {
  std::string title;
  std::string x_title;
  std::string y_title;  ///< with its unit
  std::vector<PointSeries> series;
  std::vector<std::string> categories;
  std::optional<double> band;  ///< a pale band from -band to +band, behind the points
  std::string band_name;       ///< what it is, in the legend
};

/// A shape true to scale, without axes: a circle with what lies about it. x and y have one scale; a bar at the
/// lower left, `scale_bar` long in the panel's unit, says how long that is.
struct ShapePanel {
  std::string title;
  std::vector<PointSeries> series;
  double scale_bar = 0.0;
  std::string scale_name;
  std::string value_name{};  ///< what the values of its points are, with their unit
};

/// Points and lines in panels, all diagrams or all shapes, side by side in rows of `columns`. From 1 to 60
/// categories; crowded labels turn upright or thin out. In every text `x_{abc}` sets abc as a subscript.
struct PointChart {
  std::string title;
  std::string subtitle;
  std::string note;  ///< under the picture
  int columns = 1;
  bool legend_a_panel = false;  ///< each diagram has its own: their series are of different things that look alike
  std::vector<PointPanel> diagrams;
  std::vector<ShapePanel> shapes;
};

/// Draws the chart. Throws std::invalid_argument when there is no panel or both kinds, when errors or values and
/// points of a series differ in number, or when `size` is too small; std::runtime_error when offscreen rendering is
/// not to be had.
Image render(const PointChart& chart, Size size = {1200, 700});

}  // namespace stiffscope::render
