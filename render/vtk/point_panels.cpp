#include "render/vtk/point_panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "render/vtk/flat_picture.h"
#include "render/vtk/marks.h"

namespace stiffscope {

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
        if (series.errors.empty() || series.errors.size() == series.points.size()) continue;
        throw std::invalid_argument(fmt::format("point chart '{}': series '{}' has {} errors for {} points",
                                                chart.title, series.name, series.errors.size(),
                                                series.points.size()));
      }
    }
  };
  check(chart.diagrams);
  check(chart.shapes);
}

Key keyOf(PointMark mark) {
  switch (mark) {
    case PointMark::Ring:
      return Key::HollowPoint;
    case PointMark::Diamond:
      return Key::Diamond;
    case PointMark::Square:
      return Key::Square;
    case PointMark::None:
      return Key::Median;
    case PointMark::Disc:
      break;
  }
  return Key::Point;
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
      if (panel.band) add({Key::Square, colours::kGrid, panel.band_name});
    }
  }
  return entries;
}

template <class Panel, class Draw>
void drawGrid(Canvas& canvas, const Box& free, const std::vector<Panel>& panels, int columns,
              const Draw& draw) {
  const auto across = static_cast<std::size_t>(columns);
  const std::size_t rows = (panels.size() + across - 1) / across;
  const double gap = 18 * canvas.unit();
  const double width = (free.width() + gap) / static_cast<double>(across);
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
  takeLegend(canvas, free, chart.shapes.empty() ? legendOf(chart.diagrams) : legendOf(chart.shapes));
  takeNote(canvas, free, chart.note);
  drawGrid(canvas, free, chart.diagrams, chart.columns, drawDiagram);
  drawGrid(canvas, free, chart.shapes, chart.columns, drawShape);
}

bool finite(Spot spot) { return std::isfinite(spot.x) && std::isfinite(spot.y); }

}  // namespace

void drawPointMark(Canvas& canvas, Spot centre, double radius, Colour colour, PointMark mark) {
  switch (mark) {
    case PointMark::Disc:
    case PointMark::Ring:
      drawPoint(canvas, centre, radius, colour, mark == PointMark::Ring);
      break;
    case PointMark::Diamond:
      drawDiamond(canvas, centre, 1.15 * radius, colour);
      break;
    case PointMark::Square:
      canvas.fill({centre.x - 0.9 * radius, centre.y - 0.9 * radius, centre.x + 0.9 * radius,
                   centre.y + 0.9 * radius},
                  colour);
      break;
    case PointMark::None:
      break;
  }
}

void drawMarks(Canvas& canvas, const PointSeries& series, const std::vector<Spot>& spots, double radius) {
  for (std::size_t i = 1; series.joined && i < spots.size(); ++i) {
    if (finite(spots[i - 1]) && finite(spots[i]))
      canvas.line(spots[i - 1], spots[i], series.colour, 1.5 * canvas.unit());
  }
  if (series.mark == PointMark::None) return;
  for (const Spot& spot : spots) {
    if (finite(spot)) drawPointMark(canvas, spot, radius, series.colour, series.mark);
  }
}

Image drawPoints(const PointChart& chart, Size size) {
  requireConsistent(chart);
  return drawFlat(size, [&chart](Canvas& canvas) { paintChart(canvas, chart); });
}

}  // namespace stiffscope
