// One shape of a point chart: true to scale, without axes.
#include <algorithm>
#include <cmath>

#include "render/vtk/point_panels.h"

namespace stiffscope {

void drawShape(Canvas& canvas, const Box& cell, const ShapePanel& panel) {
  const double u = canvas.unit();
  TextStyle title = axisTitleStyle(canvas);
  title.bold = true;
  canvas.text(canvas.shortened(panel.title, cell.width(), title), {cell.left, cell.top}, AlignX::Left,
              AlignY::Top, title);
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
    std::vector<Spot> spots;
    for (const PlotPoint& point : series.points)
      spots.push_back({free.middleX() + scale * point.x, free.middleY() - scale * point.y});
    drawMarks(canvas, series, spots, radius);
  }
  if (panel.scale_name.empty()) return;
  const double bar = scale * panel.scale_bar, y = cell.bottom - canvas.measure("0", label).y / 2;
  canvas.line({cell.left, y}, {cell.left + bar, y}, colours::kInk, 2 * u);
  for (const double x : {cell.left, cell.left + bar})
    canvas.line({x, y - 5 * u}, {x, y + 5 * u}, colours::kInk, 2 * u);
  const double from = cell.left + bar + 8 * u;
  canvas.text(canvas.shortened(panel.scale_name, cell.right - from, label), {from, y}, AlignX::Left,
              AlignY::Centre, label);
}

}  // namespace stiffscope
