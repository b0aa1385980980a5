#include "render/vtk/canvas.h"

#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkPen.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace stiffscope {

Canvas::Canvas(vtkContext2D& context, const Surface& surface, Fonts fonts)
    : context_(context),
      surface_(surface),
      fonts_(std::move(fonts)),
      unit_(std::clamp(std::min(surface.size.width / 1200.0, surface.size.height / 700.0), 0.7, 4.0)) {
  context_.GetPen()->SetLineType(vtkPen::NO_PEN);
}

Box Canvas::all() const {
  return {0, 0, static_cast<double>(surface_.size.width), static_cast<double>(surface_.size.height)};
}

double Canvas::snapped(double x) { return std::round(x * kSupersampling) / kSupersampling; }

void Canvas::polygon(const std::vector<Spot>& corners, Colour colour) {
  std::vector<float> points;
  points.reserve(2 * corners.size());
  for (const Spot& corner : corners) {
    points.push_back(static_cast<float>(corner.x * surface_.scale));
    points.push_back(static_cast<float>((surface_.size.height - corner.y) * surface_.scale));
  }
  context_.GetBrush()->SetColor(colour.red, colour.green, colour.blue, 255);
  context_.DrawPolygon(points.data(), static_cast<int>(corners.size()));
}

void Canvas::fill(const Box& box, Colour colour) {
  polygon({{box.left, box.top}, {box.right, box.top}, {box.right, box.bottom}, {box.left, box.bottom}},
          colour);
}

void Canvas::outline(const Box& box, Colour colour, double width) {
  const double w = width;
  fill({box.left, box.top, box.right, box.top + w}, colour);
  fill({box.left, box.bottom - w, box.right, box.bottom}, colour);
  fill({box.left, box.top, box.left + w, box.bottom}, colour);
  fill({box.right - w, box.top, box.right, box.bottom}, colour);
}

// VTK's own wide lines depend on the driver; a rectangle does not.
void Canvas::line(Spot from, Spot to, Colour colour, double width, double dash) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (!(length > 0)) return;
  const Spot along{(to.x - from.x) / length, (to.y - from.y) / length};
  const Spot across{-along.y * width / 2, along.x * width / 2};
  const double piece = dash > 0 ? dash : length;
  for (double s = 0; s<length; s += dash> 0 ? 1.7 * dash : length) {
    const double e = std::min(s + piece, length);
    const Spot a{from.x + along.x * s, from.y + along.y * s};
    const Spot b{from.x + along.x * e, from.y + along.y * e};
    polygon({{a.x + across.x, a.y + across.y},
             {b.x + across.x, b.y + across.y},
             {b.x - across.x, b.y - across.y},
             {a.x - across.x, a.y - across.y}},
            colour);
  }
}

void Canvas::disc(Spot centre, double radius, Colour colour) {
  constexpr int kCorners = 32;
  std::vector<Spot> corners;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * M_PI * i / kCorners;
    corners.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  polygon(corners, colour);
}

}  // namespace stiffscope
