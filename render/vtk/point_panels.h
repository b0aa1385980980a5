#pragma once

#include "render/point_chart.h"
#include "render/vtk/chart_frame.h"

namespace stiffscope::render {

Image drawPoints(const PointChart& chart, Size size);

/// A diagram with its axes, title and titles of axes in `cell`.
void drawDiagram(Canvas& canvas, const Box& cell, const PointPanel& panel);
/// A shape true to scale, as large as `cell` allows.
void drawShape(Canvas& canvas, const Box& cell, const ShapePanel& panel);

/// Line and marks of a series at these spots; a spot that is not finite is left out.
void drawMarks(Canvas& canvas, const PointSeries& series, const std::vector<Spot>& spots, double radius);
void drawPointMark(Canvas& canvas, Spot centre, double radius, Colour colour, PointMark mark);

}  // namespace stiffscope::render
