#pragma once

#include <string>
#include <vector>

#include "render/vtk/canvas.h"

namespace stiffscope {

/// Sets labels beside their spots, where they cover neither each other nor what is reported as taken.
class LabelPlacer {
 public:
  LabelPlacer(Canvas& canvas, const Box& room) : canvas_(canvas), room_(room) {}

  void take(const Box& box) { taken_.push_back(box); }
  /// Takes a band along the line.
  void takeLine(Spot from, Spot to, double width);
  /// Writes `text` next to `spot`, `clearance` pixels from it at least, where least is covered; a thin line
  /// leads to it when it had to go far.
  void place(const std::string& text, Spot spot, double clearance, const TextStyle& style);

 private:
  double coverage(const Box& box) const;

  Canvas& canvas_;
  Box room_;
  std::vector<Box> taken_;
};

}  // namespace stiffscope
