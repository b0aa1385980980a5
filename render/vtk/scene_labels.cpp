#include "render/vtk/scene_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stiffscope {

void LabelPlacer::takeLine(Spot from, Spot to, double width) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const int pieces = std::max(1, static_cast<int>(length / width));
  for (int i = 0; i <= pieces; ++i) {
    const double share = static_cast<double>(i) / pieces;
    const Spot at{std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share)};
    take({at.x - width / 2, at.y - width / 2, at.x + width / 2, at.y + width / 2});
  }
}

double LabelPlacer::coverage(const Box& box) const {
  double covered = 0;
  for (const Box& other : taken_) {
    if (!box.overlaps(other)) continue;
    covered += (std::min(box.right, other.right) - std::max(box.left, other.left)) *
               (std::min(box.bottom, other.bottom) - std::max(box.top, other.top));
  }
  const bool inside = box.left >= room_.left && box.right <= room_.right && box.top >= room_.top &&
                      box.bottom <= room_.bottom;
  return inside ? covered : covered + 1e6;
}

void LabelPlacer::place(const std::string& text, Spot spot, double clearance, const TextStyle& style) {
  const Spot extent = canvas_.measure(text, style);
  constexpr std::array<Spot, 8> kSides = {
      {{1, -0.6}, {-1, -0.6}, {1, 0.6}, {-1, 0.6}, {1, 0}, {-1, 0}, {0, -1}, {0, 1}}};
  Box best;
  double best_distance = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const double distance : {1.0, 1.8, 3.0, 4.5, 6.5}) {
    for (const Spot& side : kSides) {
      const double reach = clearance * distance;
      const double x = spot.x + side.x * (reach + extent.x / 2);
      const double y = spot.y + side.y * (reach + extent.y / 2);
      const Box box{x - extent.x / 2, y - extent.y / 2, x + extent.x / 2, y + extent.y / 2};
      // A little covered nearby is better than nothing far away.
      const double cost = coverage(box) + 4 * (distance - 1) * canvas_.unit();
      if (cost < least) {
        least = cost;
        best = box;
        best_distance = distance;
      }
    }
  }
  if (best_distance > 2) {
    const Spot end{std::clamp(spot.x, best.left, best.right), std::clamp(spot.y, best.top, best.bottom)};
    canvas_.line(spot, end, style.colour, canvas_.unit());
  }
  // A rim of paper sets the letters off from the arm.
  TextStyle rim = style;
  rim.colour = canvas_.palette().paper;
  for (const Spot& side : kSides) {
    canvas_.text(text, {best.left + 1.5 * side.x, best.top + 1.5 * side.y}, AlignX::Left, AlignY::Top, rim);
  }
  canvas_.text(text, {best.left, best.top}, AlignX::Left, AlignY::Top, style);
  take(best);
}

}  // namespace stiffscope
