#pragma once

#include <array>
#include <cstddef>

#include "render/point_chart.h"

namespace stiffscope {

/// Colour and mark of the `index`th of several things without a colour of their own (reflectors, directions,
/// nests): marks go on changing where colours come again.
inline PointSeries seriesLook(std::size_t index) {
  constexpr std::array<PointMark, 3> kMarks{PointMark::Disc, PointMark::Square, PointMark::Diamond};
  PointSeries series;
  series.colour = colours::kSeries[index % colours::kSeries.size()];
  series.mark = kMarks[index % kMarks.size()];
  return series;
}

}  // namespace stiffscope
