#include "render/vtk/spread_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stiffscope {

namespace {

constexpr double kTailShare = 1.5;  // how far beyond the boxes the axis follows whiskers and means
constexpr double kRoom = 0.04;      // of the range, at either end

}  // namespace

ValueRange rangeOf(const SpreadPanel& panel) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  ValueRange boxes{kInfinity, -kInfinity};
  const auto include = [](ValueRange& range, double x) {
    range = {std::min(range.lower, x), std::max(range.upper, x)};
  };
  for (std::size_t m = 0; m < panel.spreads.size(); ++m) {
    if (!panel.spreads[m]) continue;
    include(boxes, panel.spreads[m]->p25);
    include(boxes, panel.spreads[m]->p75);
    const bool has_reference = m < panel.references.size() && panel.references[m].has_value();
    if (has_reference && std::isfinite(*panel.references[m])) include(boxes, *panel.references[m]);
  }
  if (boxes.lower > boxes.upper) boxes = {0, 1};

  const double tail = kTailShare * (boxes.upper - boxes.lower);
  ValueRange range = boxes;
  for (const auto& spread : panel.spreads) {
    if (!spread) continue;
    for (const double x : {spread->p5, spread->p95, spread->mean}) {
      // Boxes without height say nothing about what is far.
      include(range, tail > 0 ? std::clamp(x, boxes.lower - tail, boxes.upper + tail) : x);
    }
  }
  double room = kRoom * (range.upper - range.lower);
  if (!(room > 0)) room = range.upper != 0 ? 0.1 * std::abs(range.upper) : 1;
  range = {panel.axis_min.value_or(range.lower - room), panel.axis_max.value_or(range.upper + room)};
  if (!(range.upper > range.lower)) range.upper = range.lower + room;
  return range;
}

std::string noteOn(const SpreadChart& chart, const std::vector<ValueRange>& ranges) {
  std::string note = "Box: 25 to 75 % of the values; whiskers: 5 to 95 %.";
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const ValueRange& range = ranges[i];
    const auto off = [&range](const std::optional<Spread>& s) {
      return s && (std::min(s->p5, s->mean) < range.lower || std::max(s->p95, s->mean) > range.upper);
    };
    const auto& spreads = chart.panels[i].spreads;
    if (std::any_of(spreads.begin(), spreads.end(), off)) {
      return note + " Arrow: whisker or mean goes on beyond the axis; such a mean is printed.";
    }
  }
  return note;
}

}  // namespace stiffscope
