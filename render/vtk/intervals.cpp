#include "render/vtk/painters.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "render/vtk/chart_frame.h"
#include "render/vtk/offscreen_picture.h"

namespace stiffscope::render {

namespace {

// What can stand on the axis: on a logarithmic one only what is positive.
bool placeable(double value, bool logarithmic) { return std::isfinite(value) && (!logarithmic || value > 0); }

// Where the value has no place on the axis, its interval may be of what is possible: "at least 5" of a fit of -4.
bool fits(const Interval& i, bool logarithmic) {
  if (!std::isfinite(i.value)) return true;
  if (i.lower > i.upper) return false;
  return !placeable(i.value, logarithmic) || !(i.lower > i.value || i.upper < i.value);
}

void requireConsistent(const IntervalChart& chart) {
  const std::size_t count = chart.categories.size();
  if (count == 0 || chart.series.empty()) {
    throw std::invalid_argument(
        fmt::format("interval chart '{}' has {} categories and {} series, expected one of each at least", chart.title,
                    count, chart.series.size()));
  }
  if (!chart.references.empty() && chart.references.size() != count) {
    throw std::invalid_argument(fmt::format("interval chart '{}' has {} references for {} categories", chart.title,
                                            chart.references.size(), count));
  }
  for (const IntervalSeries& series : chart.series) {
    if (series.intervals.size() != count) {
      throw std::invalid_argument(fmt::format("interval chart '{}': series '{}' has {} intervals for {} categories",
                                              chart.title, series.name, series.intervals.size(), count));
    }
    for (const Interval& i : series.intervals) {
      if (!fits(i, chart.logarithmic)) {
        throw std::invalid_argument(fmt::format("interval chart '{}': series '{}' has {} in an interval from {} to {}",
                                                chart.title, series.name, i.value, i.lower, i.upper));
      }
    }
  }
}

YAxis axisFor(const Canvas& canvas, const IntervalChart& chart, double height) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double lower = kInfinity, upper = -kInfinity;
  const auto include = [&](double value) {
    if (!placeable(value, chart.logarithmic)) return;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  };
  for (const IntervalSeries& series : chart.series) {
    for (const Interval& interval : series.intervals) {
      if (!std::isfinite(interval.value)) continue;
      include(interval.value);
      include(interval.lower);
      include(interval.upper);
    }
  }
  for (const double reference : chart.references) include(reference);
  if (lower > upper) return chart.logarithmic ? logAxis(1, 10) : linearAxis(canvas, 0, 1, height);
  if (chart.logarithmic) return logAxis(lower, upper);
  // Zero is shown when it is near: an axis cut off just above it would deceive.
  if (lower > 0 && lower < 0.5 * upper) lower = 0;
  if (upper < 0 && upper > 0.5 * lower) upper = 0;
  return linearAxis(canvas, lower, upper, height);
}

bool offLogAxis(const Interval& interval) {
  return std::isfinite(interval.value) && (interval.value <= 0 || interval.lower <= 0);
}

void drawInterval(Canvas& canvas, double x, const YAxis& axis, const Interval& interval, Colour colour, double radius) {
  const double u = canvas.unit();
  // A side without an end goes to the edge of the diagram, and has no cap there.
  const auto at = [&axis](double value) {
    if (std::isinf(value) && value > 0.0) return axis.at(axis.upper);
    return placeable(value, axis.logarithmic) ? axis.at(std::clamp(value, axis.lower, axis.upper)) : axis.bottom;
  };
  const bool known = !std::isnan(interval.lower) && !std::isnan(interval.upper);
  if (known && at(interval.lower) > at(interval.upper)) {
    drawWhisker(canvas, x, at(interval.lower), at(interval.upper), 0.9 * radius, colour,
                placeable(interval.lower, axis.logarithmic), placeable(interval.upper, axis.logarithmic));
  }
  if (axis.logarithmic && offLogAxis(interval)) drawArrowMark(canvas, {x, axis.bottom}, 11 * u, colour, false);
  if (placeable(interval.value, axis.logarithmic)) {
    drawPoint(canvas, {x, at(interval.value)}, radius, colour, interval.doubtful);
  }
}

void drawSeries(Canvas& canvas, const Box& plot, const YAxis& axis, const IntervalChart& chart) {
  const double u = canvas.unit();
  const double band = plot.width() / static_cast<double>(chart.categories.size());
  const double step = std::min(0.8 * band / static_cast<double>(chart.series.size()), 44 * u);
  const double radius = std::clamp(0.3 * step, 2.0 * u, 6.5 * u);
  for (std::size_t i = 0; i < chart.categories.size(); ++i) {
    const double middle = plot.left + (static_cast<double>(i) + 0.5) * band;
    if (i < chart.references.size() && placeable(chart.references[i], axis.logarithmic)) {
      const double y = axis.at(chart.references[i]);
      canvas.line({middle - 0.45 * band, y}, {middle + 0.45 * band, y}, colours::kInk, 1.75 * u, 5 * u);
    }
    for (std::size_t s = 0; s < chart.series.size(); ++s) {
      const Interval& interval = chart.series[s].intervals[i];
      if (!std::isfinite(interval.value)) continue;
      const double x = middle + (static_cast<double>(s) - 0.5 * static_cast<double>(chart.series.size() - 1)) * step;
      drawInterval(canvas, x, axis, interval, chart.series[s].colour, radius);
      const bool placed = placeable(interval.value, axis.logarithmic);
      canvas.mark({x, placed ? axis.at(interval.value) : axis.bottom}, chart.series[s].name, chart.categories[i],
                  interval.value);
    }
  }
}

void drawBandEdges(Canvas& canvas, const Box& plot, const YAxis& axis, const IntervalChart& chart) {
  const double u = canvas.unit();
  const double band = plot.width() / static_cast<double>(chart.categories.size());
  for (std::size_t i = 1; i < chart.categories.size(); ++i) {
    const double edge = Canvas::snapped(plot.left + static_cast<double>(i) * band);
    canvas.fill({edge - 0.5, plot.top, edge + 0.5, plot.bottom}, colours::kGrid);
  }
  canvas.fill({plot.left, plot.bottom - 0.5 * u, plot.right, plot.bottom + 0.5 * u}, colours::kAxis);
  if (!axis.logarithmic && axis.lower < 0 && axis.upper > 0) {
    canvas.fill({plot.left, axis.at(0) - 0.5 * u, plot.right, axis.at(0) + 0.5 * u}, colours::kAxis);
  }
}

void paintChart(Canvas& canvas, const IntervalChart& chart) {
  CategoryFrame frame{chart.title, chart.subtitle, "", chart.y_title, chart.category_title, chart.categories, {}, {}};
  bool any_off = false;
  for (const IntervalSeries& series : chart.series) {
    frame.legend.push_back({Key::point, series.colour, series.name});
    any_off = any_off || std::any_of(series.intervals.begin(), series.intervals.end(), offLogAxis);
  }
  frame.legend.push_back({Key::hollow_point, colours::kFaintInk, chart.doubtful_name});
  if (!chart.references.empty()) frame.legend.push_back({Key::dashes, colours::kInk, chart.reference_name});
  if (chart.logarithmic && any_off) {
    frame.note = "Arrow: value or interval reaches zero or below, which has no place on a logarithmic axis.";
  }
  frame.axis = [&](double height) { return axisFor(canvas, chart, height); };
  drawInCategoryFrame(canvas, frame, [&](const Box& plot, const YAxis& axis) {
    drawBandEdges(canvas, plot, axis, chart);
    drawSeries(canvas, plot, axis, chart);
  });
}

}  // namespace

Image drawIntervals(const IntervalChart& chart, Size size) {
  requireConsistent(chart);
  return drawFlat(size, [&chart](Canvas& canvas) { paintChart(canvas, chart); });
}

}  // namespace stiffscope::render
