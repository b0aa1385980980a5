#include "render/vtk/chart_frame.h"
#include "render/vtk/painters.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "render/vtk/chart_frame.h"
#include "render/vtk/offscreen_picture.h"

// One diagram of a point chart: axes, band, whiskers, points.

// One shape of a point chart: true to scale, without axes.

namespace stiffscope::render {

/// A diagram with its axes, title and titles of axes in `cell`; under its title its own legend, in so much room.
void drawDiagram(Canvas& canvas, const Box& cell, const PointPanel& panel, double legend_height);
/// A shape true to scale, as large as `cell` allows.
void drawShape(Canvas& canvas, const Box& cell, const ShapePanel& panel);

/// Line and marks of a series at these spots; a spot that is not finite is left out.
void drawMarks(Canvas& canvas, const PointSeries& series, const std::vector<Spot>& spots, double radius);
void drawPointMark(Canvas& canvas, Spot centre, double radius, Colour colour, PointMark mark);

namespace {

/// Notes what the points of a series say to a pointer.
void noteValues(Canvas& canvas, const PointSeries& series, const std::vector<Spot>& spots, const std::string& what,
                const std::string& quantity) {
  for (std::size_t i = 0; i < series.values.size(); ++i) {
    const PointValue& own = series.values[i];
    canvas.mark(spots[i], what, own.category, own.value, own.at, quantity);
  }
}

template <class Panel>
std::vector<LegendEntry> legendOf(const std::vector<Panel>& panels);

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
    canvas.text(ticks.labels[i], {x, plot.bottom + 6 * u}, AlignX::centre, AlignY::top, style);
  }
  if (title.empty()) return;
  const TextStyle title_style = axisTitleStyle(canvas);
  canvas.text(canvas.shortened(title, plot.width(), title_style),
              {plot.middleX(), plot.bottom + 10 * u + canvas.measure("0", style).y}, AlignX::centre, AlignY::top,
              title_style);
}

void drawSeries(Canvas& canvas, const Box& plot, const Range& x_range, const YAxis& axis, const PointPanel& panel,
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
    drawWhisker(canvas, spots[i].x, axis.at(y - error), axis.at(y + error), 0.8 * radius, series.colour, true, true);
  }
  drawMarks(canvas, series, spots, radius);
  const std::string what = panel.title.empty() ? series.name : panel.title + ": " + series.name;
  if (!series.values.empty()) {
    noteValues(canvas, series, spots, what, panel.y_title);
    return;
  }
  for (std::size_t i = 0; i < spots.size() && series.mark != PointMark::none; ++i) {
    const double x = series.points[i].x;
    const auto category = static_cast<std::size_t>(std::lround(std::max(x, 0.0)));
    const bool named = !panel.categories.empty() && category < panel.categories.size();
    canvas.mark(spots[i], what, named ? panel.categories[category] : "", series.points[i].y, x, panel.y_title);
  }
}

}  // namespace

void drawDiagram(Canvas& canvas, const Box& cell, const PointPanel& panel, double legend_height) {
  const double u = canvas.unit();
  Box free = cell;
  if (!panel.title.empty()) {
    TextStyle title = axisTitleStyle(canvas);
    title.bold = true;
    canvas.text(canvas.shortened(panel.title, cell.width(), title), {cell.left, cell.top}, AlignX::left, AlignY::top,
                title);
    free.top += canvas.measure("0", title).y + 8 * u;
  }
  if (legend_height > 0) {
    Box above = free;
    takeLegend(canvas, above, legendOf(std::vector<PointPanel>{panel}));
    free.top += legend_height;
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
    labels = fitCategoryLabels(canvas, panel.categories, plot.width() / static_cast<double>(panel.categories.size()),
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
  for (const PointSeries& series : panel.series) drawSeries(canvas, plot, x_range, axis, panel, series);
  if (panel.categories.empty()) {
    drawNumbers(canvas, plot, x_range, panel.x_title);
  } else {
    drawCategories(canvas, plot, panel.categories, labels, panel.x_title);
  }
}

void drawShape(Canvas& canvas, const Box& cell, const ShapePanel& panel) {
  const double u = canvas.unit();
  TextStyle title = axisTitleStyle(canvas);
  title.bold = true;
  canvas.text(canvas.shortened(panel.title, cell.width(), title), {cell.left, cell.top}, AlignX::left, AlignY::top,
              title);
  Box free = cell;
  free.top += canvas.measure("0", title).y + 8 * u;
  const TextStyle label = labelStyle(canvas);
  if (!panel.scale_name.empty()) free.bottom -= canvas.measure("0", label).y + 8 * u;

  double reach = 0.0;
  for (const PointSeries& series : panel.series) {
    for (const PlotPoint& point : series.points) {
      if (std::isfinite(point.x) && std::isfinite(point.y))
        reach = std::max({reach, std::abs(point.x), std::abs(point.y)});
    }
  }
  if (!(reach > 0.0)) reach = 1.0;
  const double radius = 4 * u;
  const double scale = (std::min(free.width(), free.height()) / 2 - 2 * radius) / reach;
  for (const PointSeries& series : panel.series) {
    const auto spotsOf = [&](const std::vector<PlotPoint>& points) {
      std::vector<Spot> spots;
      for (const PlotPoint& point : points)
        spots.push_back({free.middleX() + scale * point.x, free.middleY() - scale * point.y});
      return spots;
    };
    const std::vector<Spot> line = spotsOf(series.line);
    for (std::size_t i = 1; i < line.size(); ++i) canvas.line(line[i - 1], line[i], series.colour, 1.5 * u);
    const std::vector<Spot> spots = spotsOf(series.points);
    drawMarks(canvas, series, spots, radius);
    const bool both = !panel.title.empty() && !series.name.empty();
    noteValues(canvas, series, spots, panel.title + (both ? ": " : "") + series.name, panel.value_name);
  }
  if (panel.scale_name.empty()) return;
  const double bar = scale * panel.scale_bar, y = cell.bottom - canvas.measure("0", label).y / 2;
  canvas.line({cell.left, y}, {cell.left + bar, y}, colours::kInk, 2 * u);
  for (const double x : {cell.left, cell.left + bar}) canvas.line({x, y - 5 * u}, {x, y + 5 * u}, colours::kInk, 2 * u);
  const double from = cell.left + bar + 8 * u;
  canvas.text(canvas.shortened(panel.scale_name, cell.right - from, label), {from, y}, AlignX::left, AlignY::centre,
              label);
}

namespace {

void requireConsistent(const PointChart& chart) {
  if (chart.diagrams.empty() == chart.shapes.empty() || chart.columns < 1) {
    throw std::invalid_argument(
        fmt::format("point chart '{}' has {} diagrams and {} shapes in {} columns, expected one kind of panel",
                    chart.title, chart.diagrams.size(), chart.shapes.size(), chart.columns));
  }
  const auto check = [&chart](const auto& panels) {
    for (const auto& panel : panels) {
      for (const PointSeries& series : panel.series) {
        const std::size_t points = series.points.size();
        const auto requireOneAPoint = [&](std::size_t count, const char* what) {
          if (count == 0 || count == points) return;
          throw std::invalid_argument(fmt::format("point chart '{}': series '{}' has {} {} for {} points", chart.title,
                                                  series.name, count, what, points));
        };
        requireOneAPoint(series.errors.size(), "errors");
        requireOneAPoint(series.values.size(), "values");
      }
    }
  };
  check(chart.diagrams);
  check(chart.shapes);
}

Key keyOf(PointMark mark) {
  switch (mark) {
    case PointMark::ring:
      return Key::hollow_point;
    case PointMark::diamond:
      return Key::diamond;
    case PointMark::square:
      return Key::square;
    case PointMark::none:
      return Key::median;
    case PointMark::disc:
      break;
  }
  return Key::point;
}

template <class Panel>
std::vector<LegendEntry> legendOf(const std::vector<Panel>& panels) {
  std::vector<LegendEntry> entries;
  const auto add = [&entries](const LegendEntry& entry) {
    const bool there = std::any_of(entries.begin(), entries.end(),
                                   [&entry](const LegendEntry& other) { return other.name == entry.name; });
    if (!there) entries.push_back(entry);
  };
  for (const Panel& panel : panels) {
    for (const PointSeries& series : panel.series) add({keyOf(series.mark), series.colour, series.name});
    if constexpr (requires { panel.band; }) {
      if (panel.band) add({Key::square, colours::kGrid, panel.band_name});
    }
  }
  return entries;
}

/// Of a panel in a grid of so many columns.
double panelWidth(const Canvas& canvas, const Box& free, int columns) {
  const double gap = 18 * canvas.unit();
  return (free.width() + gap) / columns - gap;
}

template <class Panel, class Draw>
void drawGrid(Canvas& canvas, const Box& free, const std::vector<Panel>& panels, int columns, const Draw& draw) {
  const auto across = static_cast<std::size_t>(columns);
  const std::size_t rows = (panels.size() + across - 1) / across;
  const double gap = 18 * canvas.unit();
  const double width = panelWidth(canvas, free, columns) + gap;
  const double height = (free.height() + gap) / static_cast<double>(rows);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double left = free.left + static_cast<double>(i % across) * width;
    const double top = free.top + static_cast<double>(i / across) * height;
    draw(canvas, Box{left, top, left + width - gap, top + height - gap}, panels[i]);
  }
}

void paintChart(Canvas& canvas, const PointChart& chart) {
  Box free = canvas.all();
  takeMargin(canvas, free);
  takeHeader(canvas, free, chart.title, chart.subtitle);
  double legend_height = 0;  // of all panels the same, so that their plots stand level
  if (!chart.legend_a_panel)
    takeLegend(canvas, free, chart.shapes.empty() ? legendOf(chart.diagrams) : legendOf(chart.shapes));
  takeNote(canvas, free, chart.note);
  for (const PointPanel& panel : chart.diagrams) {
    if (!chart.legend_a_panel) break;
    const auto entries = legendOf(std::vector<PointPanel>{panel});
    legend_height = std::max(legend_height, legendHeight(canvas, panelWidth(canvas, free, chart.columns), entries));
  }
  drawGrid(
      canvas, free, chart.diagrams, chart.columns,
      [legend_height](Canvas& on, const Box& cell, const auto& panel) { drawDiagram(on, cell, panel, legend_height); });
  drawGrid(canvas, free, chart.shapes, chart.columns, drawShape);
}

bool finite(Spot spot) { return std::isfinite(spot.x) && std::isfinite(spot.y); }

}  // namespace

void drawPointMark(Canvas& canvas, Spot centre, double radius, Colour colour, PointMark mark) {
  switch (mark) {
    case PointMark::disc:
    case PointMark::ring:
      drawPoint(canvas, centre, radius, colour, mark == PointMark::ring);
      break;
    case PointMark::diamond:
      drawDiamond(canvas, centre, 1.15 * radius, colour);
      break;
    case PointMark::square:
      canvas.fill({centre.x - 0.9 * radius, centre.y - 0.9 * radius, centre.x + 0.9 * radius, centre.y + 0.9 * radius},
                  colour);
      break;
    case PointMark::none:
      break;
  }
}

void drawMarks(Canvas& canvas, const PointSeries& series, const std::vector<Spot>& spots, double radius) {
  for (std::size_t i = 1; series.joined && i < spots.size(); ++i) {
    if (finite(spots[i - 1]) && finite(spots[i]))
      canvas.line(spots[i - 1], spots[i], series.colour, 1.5 * canvas.unit());
  }
  if (series.mark == PointMark::none) return;
  for (const Spot& spot : spots) {
    if (finite(spot)) drawPointMark(canvas, spot, radius, series.colour, series.mark);
  }
}

Image drawPoints(const PointChart& chart, Size size) {
  requireConsistent(chart);
  return drawFlat(size, [&chart](Canvas& canvas) { paintChart(canvas, chart); });
}

}  // namespace stiffscope::render
