#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/colours.h"
#include "render/image.h"

namespace stiffscope::render {

/// What a box shows of a distribution: its percentiles and its mean, in the distribution's unit.
struct Spread {
  double p5 = 0;
  double p25 = 0;
  double p50 = 0;
  double p75 = 0;
  double p95 = 0;
  double mean = 0;
};

/// Percentiles by linear interpolation between order statistics (x at rank p (n - 1)), and the arithmetic
/// mean. Throws std::invalid_argument when there is no sample or one is not finite.
Spread spreadOf(std::vector<double> samples);

/// A method: one box in every panel.
struct SpreadMethod {
  std::string name;
  Colour colour;
};

/// One panel, a joint: a box per method, in the order of the chart's methods.
struct SpreadPanel {
  std::string title;                           ///< "k_{2}"
  std::vector<std::optional<Spread>> spreads;  ///< one per method; none: the method cannot identify this joint
  std::vector<std::optional<double>>
      references;                  ///< empty, or one per method: a dashed line across its box, where there is one
  std::optional<double> axis_min;  ///< fixes the axis where the default does not please
  std::optional<double> axis_max;
};

enum class SpreadAxis {
  own_per_panel,  ///< each panel has the scale its boxes need
  shared          ///< one scale for all: for values that the caller has divided by something
};

/// Distributions of identified values (Table II over all subsets of postures): per method a box over the
/// middle half, the median across it, whiskers over 5-95 %, a diamond at the mean.
///
/// Heavy tails: a panel's axis covers all boxes and those whiskers and means that end within 1.5 times the
/// range of the boxes; what lies beyond is cut at the edge, marked by an arrow there, and a mean off the axis
/// is printed as a number. A note under the picture says so whenever it happened. In every text `x_{abc}`
/// sets abc as a subscript.
struct SpreadChart {
  std::string title;
  std::string subtitle;
  std::string y_title;         ///< with its unit: "Stiffness (10⁶ Nm/rad)"
  std::string reference_name;  ///< of the dashed lines, in the legend: "paper, Table II"
  std::vector<SpreadMethod> methods;
  std::vector<SpreadPanel> panels;
  SpreadAxis axis = SpreadAxis::own_per_panel;
};

/// Draws the chart. Throws std::invalid_argument when there is no method or panel, when the lengths in a
/// panel are not the number of methods, when percentiles are out of order or not finite, or when `size` is
/// too small; std::runtime_error when offscreen rendering is not to be had.
Image render(const SpreadChart& chart, Size size = {1200, 700});

}  // namespace stiffscope::render
