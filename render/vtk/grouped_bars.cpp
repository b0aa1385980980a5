#include "render/vtk/painters.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "render/vtk/chart_frame.h"
#include "render/vtk/offscreen_picture.h"

namespace stiffscope::render {

namespace {

void requireConsistent(const GroupedBarChart& chart) {
  if (chart.categories.empty() || chart.series.empty()) {
    throw std::invalid_argument(
        fmt::format("bar chart '{}' has {} categories and {} series, expected one of each at least", chart.title,
                    chart.categories.size(), chart.series.size()));
  }
  for (const BarSeries& series : chart.series) {
    const bool errors_fit = series.errors.empty() || series.errors.size() == series.values.size();
    if (series.values.size() != chart.categories.size() || !errors_fit) {
      throw std::invalid_argument(
          fmt::format("bar chart '{}': series '{}' has {} values and {} errors for {} categories", chart.title,
                      series.name, series.values.size(), series.errors.size(), chart.categories.size()));
    }
  }
}

double errorAt(const BarSeries& series, std::size_t i) {
  return i < series.errors.size() && std::isfinite(series.errors[i]) ? std::abs(series.errors[i]) : 0;
}

YAxis axisFor(const Canvas& canvas, const GroupedBarChart& chart, double height) {
  double lower = 0, upper = 0;
  for (const BarSeries& series : chart.series) {
    for (std::size_t i = 0; i < series.values.size(); ++i) {
      if (!std::isfinite(series.values[i])) continue;
      lower = std::min(lower, series.values[i] - errorAt(series, i));
      upper = std::max(upper, series.values[i] + errorAt(series, i));
    }
  }
  if (lower == 0 && upper == 0) upper = 1;
  return linearAxis(canvas, lower, upper, height);
}

void drawBars(Canvas& canvas, const Box& plot, const YAxis& axis, const GroupedBarChart& chart) {
  const double u = canvas.unit();
  const double band = plot.width() / static_cast<double>(chart.categories.size());
  const auto count = static_cast<double>(chart.series.size());
  // One or two groups would otherwise fill the picture with four slabs.
  const double bar = std::min(0.8 * band / count, 90 * u);
  const double zero = Canvas::snapped(axis.at(0));
  for (std::size_t i = 0; i < chart.categories.size(); ++i) {
    const double start = plot.left + (static_cast<double>(i) + 0.5) * band - bar * count / 2;
    for (std::size_t s = 0; s < chart.series.size(); ++s) {
      const BarSeries& series = chart.series[s];
      const double value = series.values[i];
      if (!std::isfinite(value)) continue;
      const double left = Canvas::snapped(start + bar * static_cast<double>(s));
      const double right =
          std::max(left + 1, Canvas::snapped(start + bar * static_cast<double>(s + 1)) - (bar > 8 * u ? u : 0));
      const double end = Canvas::snapped(axis.at(value));
      canvas.fill({left, std::min(zero, end), right, std::max(zero, end)}, series.colour);
      canvas.mark({(left + right) / 2, end}, series.name, chart.categories[i], value);
      if (const double error = errorAt(series, i); error > 0) {
        drawWhisker(canvas, (left + right) / 2, axis.at(value - error), axis.at(value + error),
                    std::min(0.25 * bar, 7 * u), colours::kInk, true, true);
      }
    }
  }
  canvas.fill({plot.left, zero - 0.5 * u, plot.right, zero + 0.5 * u}, colours::kAxis);
}

void paintChart(Canvas& canvas, const GroupedBarChart& chart) {
  CategoryFrame frame{chart.title, chart.subtitle, "", chart.y_title, chart.category_title, chart.categories, {}, {}};
  for (const BarSeries& series : chart.series) frame.legend.push_back({Key::square, series.colour, series.name});
  frame.axis = [&](double height) { return axisFor(canvas, chart, height); };
  drawInCategoryFrame(canvas, frame, [&](const Box& plot, const YAxis& axis) { drawBars(canvas, plot, axis, chart); });
}

}  // namespace

Image drawGroupedBars(const GroupedBarChart& chart, Size size) {
  requireConsistent(chart);
  return drawFlat(size, [&chart](Canvas& canvas) { paintChart(canvas, chart); });
}

}  // namespace stiffscope::render
