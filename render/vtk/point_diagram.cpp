// One diagram of a point chart: axes, band, whiskers, points.
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/vtk/marks.h"
#include "render/vtk/point_panels.h"

namespace stiffscope {

namespace {

struct Range {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();

  void include(double value) {
    if (!std::isfinite(value)) return;
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  bool empty() const { return lower > upper; }
};

Range rangeOfY(const PointPanel& panel) {
  Range range;
  if (panel.band) {
    range.include(*panel.band);
    range.include(-*panel.band);
  }
  for (const PointSeries& series : panel.series) {
    for (std::size_t i = 0; i < series.points.size(); ++i) {
      const double error = i < series.errors.size() ? series.errors[i] : 0.0;
      range.include(series.points[i].y - error);
      range.include(series.points[i].y + error);
    }
  }
  return range.empty() ? Range{0, 1} : range;
}

Range rangeOfX(const PointPanel& panel) {
  if (!panel.categories.empty()) return {-0.5, static_cast<double>(panel.categories.size()) - 0.5};
  Range range;
  for (const PointSeries& series : panel.series) {
    for (const PlotPoint& point : series.points) range.include(point.x);
  }
  if (range.empty()) return {0, 1};
  const double room = range.upper > range.lower ? 0.03 * (range.upper - range.lower) : 1.0;
  return {range.lower - room, range.upper + room};
}

/// Numbers under the plot; as many as stand apart.
void drawNumbers(Canvas& canvas, const Box& plot, const Range& range, const std::string& title) {
  const double u = canvas.unit();
  const TextStyle style = labelStyle(canvas);
  const int most = std::max(2, static_cast<int>(plot.width() / (56 * u)));
  const Ticks ticks = linearTicks(range.lower, range.upper, most);
  for (std::size_t i = 0; i < ticks.positions.size(); ++i) {
    const double share = (ticks.positions[i] - range.lower) / (range.upper - range.lower);
    const double x = Canvas::snapped(plot.left + share * plot.width());
    canvas.fill({x - 0.5 * u, plot.bottom, x + 0.5 * u, plot.bottom + 5 * u}, colours::kAxis);
    canvas.text(ticks.labels[i], {x, plot.bottom + 6 * u}, AlignX::Centre, AlignY::Top, style);
  }
  if (title.empty()) return;
  const TextStyle title_style = axisTitleStyle(canvas);
  canvas.text(canvas.shortened(title, plot.width(), title_style),
              {plot.middleX(), plot.bottom + 10 * u + canvas.measure("0", style).y}, AlignX::Centre,
              AlignY::Top, title_style);
}

void drawSeries(Canvas& canvas, const Box& plot, const Range& x_range, const YAxis& axis,
                const PointSeries& series) {
  const double u = canvas.unit();
  const double apart = plot.width() / std::max<double>(1.0, static_cast<double>(series.points.size()));
  const double radius = std::clamp(0.3 * apart, 2.2 * u, 5 * u);
  std::vector<Spot> spots;
  for (const PlotPoint& point : series.points) {
    const double share = (point.x - x_range.lower) / (x_range.upper - x_range.lower);
    spots.push_back({plot.left + share * plot.width(), axis.at(point.y)});
  }
  for (std::size_t i = 0; i < series.errors.size(); ++i) {
    const double y = series.points[i].y, error = series.errors[i];
    if (!std::isfinite(y) || !(error > 0.0)) continue;
    drawWhisker(canvas, spots[i].x, axis.at(y - error), axis.at(y + error), 0.8 * radius, series.colour, true,
                true);
  }
  drawMarks(canvas, series, spots, radius);
}

}  // namespace

void drawDiagram(Canvas& canvas, const Box& cell, const PointPanel& panel) {
  const double u = canvas.unit();
  Box free = cell;
  if (!panel.title.empty()) {
    TextStyle title = axisTitleStyle(canvas);
    title.bold = true;
    canvas.text(canvas.shortened(panel.title, cell.width(), title), {cell.left, cell.top}, AlignX::Left,
                AlignY::Top, title);
    free.top += canvas.measure("0", title).y + 8 * u;
  }
  const double title_left = free.left;
  const std::vector<std::string> y_title = takeYTitle(canvas, free, panel.y_title);
  const Range y_range = rangeOfY(panel), x_range = rangeOfX(panel);
  YAxis axis = linearAxis(canvas, y_range.lower, y_range.upper, free.height() - 60 * u);
  Box plot = free;
  plot.left = Canvas::snapped(plot.left + tickLabelWidth(canvas, axis));
  CategoryLabels labels;
  labels.height = canvas.measure("0", labelStyle(canvas)).y;
  if (!panel.categories.empty()) {
    labels = fitCategoryLabels(canvas, panel.categories,
                               plot.width() / static_cast<double>(panel.categories.size()),
                               0.25 * free.height());
  }
  plot.bottom -= labels.height + 10 * u + (panel.x_title.empty() ? 0 : 1.2 * axisTitleStyle(canvas).size);
  drawYTitle(canvas, title_left, plot, y_title);
  axis.top = plot.top;
  axis.bottom = plot.bottom;
  if (panel.band) canvas.fill({plot.left, axis.at(*panel.band), plot.right, axis.at(-*panel.band)}, colours::kBand);
  drawYAxis(canvas, plot, axis);
  canvas.fill({plot.left, plot.bottom - 0.5 * u, plot.right, plot.bottom + 0.5 * u}, colours::kAxis);
  if (axis.lower < 0 && axis.upper > 0)
    canvas.fill({plot.left, axis.at(0) - 0.5 * u, plot.right, axis.at(0) + 0.5 * u}, colours::kAxis);
  for (const PointSeries& series : panel.series) drawSeries(canvas, plot, x_range, axis, series);
  if (panel.categories.empty()) {
    drawNumbers(canvas, plot, x_range, panel.x_title);
  } else {
    drawCategories(canvas, plot, panel.categories, labels, panel.x_title);
  }
}

}  // namespace stiffscope
