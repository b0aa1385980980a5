#pragma once

#include <string>
#include <vector>

#include "render/ticks.h"
#include "render/vtk/canvas.h"

namespace stiffscope {

enum class Key { Square, Point, HollowPoint, Dashes, Diamond, Median, ThickArrow, MediumArrow, ThinArrow };

/// A legend entry: a sign and what it means.
struct LegendEntry {
  Key key = Key::Square;
  Colour colour;
  std::string name;
};

/// The pieces that all charts share, each taking its room from the side of `free` it stands at, so that
/// nothing overlaps: what is left over is the next piece's.
void takeMargin(const Canvas& canvas, Box& free);
void takeHeader(Canvas& canvas, Box& free, const std::string& title, const std::string& subtitle);
void takeLegend(Canvas& canvas, Box& free, const std::vector<LegendEntry>& entries);
void takeNote(Canvas& canvas, Box& free, const std::string& note);
/// The title of the y axis at the left, upright: first its room, then itself, centred on `plot`.
std::vector<std::string> takeYTitle(const Canvas& canvas, Box& free, const std::string& title);
void drawYTitle(Canvas& canvas, double left, const Box& plot, const std::vector<std::string>& lines);

/// A vertical axis: which value stands where.
struct YAxis {
  double lower = 0;
  double upper = 1;
  bool logarithmic = false;
  Ticks ticks;
  double top = 0;     ///< where `upper` stands on the picture
  double bottom = 1;  ///< where `lower` does

  double at(double value) const;
  bool shows(double value) const;
};

/// An axis over [lower, upper], widened outwards to ticks (if `widen`), for a plot about `height` pixels
/// high.
YAxis linearAxis(const Canvas& canvas, double lower, double upper, double height, bool widen = true);
YAxis logAxis(double lower, double upper);

/// Room that the tick labels need at the left of a plot.
double tickLabelWidth(const Canvas& canvas, const YAxis& axis);
/// Sets the axis upon `plot` and draws grid lines, tick labels left of it, and the line of the axis.
void drawYAxis(Canvas& canvas, const Box& plot, YAxis& axis);

/// How category labels are set for bands of `band` pixels: across, upright, and only every so many.
struct CategoryLabels {
  Direction direction = Direction::Across;
  int every = 1;
  double height = 0;
};
CategoryLabels fitCategoryLabels(const Canvas& canvas, const std::vector<std::string>& categories,
                                 double band, double room);
/// Labels under the bottom of `plot`, the title below them.
void drawCategories(Canvas& canvas, const Box& plot, const std::vector<std::string>& categories,
                    const CategoryLabels& labels, const std::string& title);

/// The styles of the texts, sized to the picture.
TextStyle titleStyle(const Canvas& canvas);
TextStyle subtitleStyle(const Canvas& canvas);
TextStyle axisTitleStyle(const Canvas& canvas);
TextStyle labelStyle(const Canvas& canvas);
TextStyle noteStyle(const Canvas& canvas);

}  // namespace stiffscope
