#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "core/identification/identify.h"
#include "render/colours.h"
#include "render/point_chart.h"

namespace stiffscope::app {

/// " Drawn: 100 of 10000 postures, spread evenly." for a caption where evenlySpreadIndices left some out; empty where
/// all are drawn. More marks in one picture hide each other, and what lies on top is taken for all.
std::string drawnWords(std::size_t count, std::size_t most, const std::string& what);

/// The paper's colours: CP red, PP blue, DPP green.
inline render::Colour colourOf(identification::Method method) {
  constexpr std::array<render::Colour, 3> kByMethod{render::colours::kCp, render::colours::kPp, render::colours::kDpp};
  return kByMethod[static_cast<std::size_t>(method)];
}

/// Colour and mark of the `index`th of several things without a colour of their own (reflectors, directions,
/// nests): marks go on changing where colours come again.
inline render::PointSeries seriesLook(std::size_t index) {
  constexpr std::array<render::PointMark, 3> kMarks{render::PointMark::disc, render::PointMark::square,
                                                    render::PointMark::diamond};
  render::PointSeries series;
  series.colour = render::colours::kSeries[index % render::colours::kSeries.size()];
  series.mark = kMarks[index % kMarks.size()];
  return series;
}

}  // namespace stiffscope::app
