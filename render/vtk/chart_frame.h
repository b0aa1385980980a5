#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/ticks.h"
#include "render/vtk/canvas.h"

namespace stiffscope::render {

enum class Key { square, point, hollow_point, dashes, diamond, median, thick_arrow, medium_arrow, thin_arrow };

/// A legend entry: a sign and what it means.
struct LegendEntry {
  Key key = Key::square;
  Colour colour;
  std::string name;
};

/// The pieces that all charts share, each taking its room from the side of `free` it stands at, so that
/// nothing overlaps: what is left over is the next piece's.
void takeMargin(const Canvas& canvas, Box& free);
void takeHeader(Canvas& canvas, Box& free, const std::string& title, const std::string& subtitle);
void takeLegend(Canvas& canvas, Box& free, const std::vector<LegendEntry>& entries);
/// What that takes of a room of this width.
double legendHeight(const Canvas& canvas, double width, const std::vector<LegendEntry>& entries);
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
  Direction direction = Direction::across;
  int every = 1;
  double height = 0;
};
CategoryLabels fitCategoryLabels(const Canvas& canvas, const std::vector<std::string>& categories, double band,
                                 double room);
/// Labels under the bottom of `plot`, the title below them.
void drawCategories(Canvas& canvas, const Box& plot, const std::vector<std::string>& categories,
                    const CategoryLabels& labels, const std::string& title);

/// The styles of the texts, sized to the picture.
TextStyle titleStyle(const Canvas& canvas);
TextStyle subtitleStyle(const Canvas& canvas);
TextStyle axisTitleStyle(const Canvas& canvas);
TextStyle labelStyle(const Canvas& canvas);
TextStyle noteStyle(const Canvas& canvas);

/// What stands around values by category: header, legend, note, both axes.
struct CategoryFrame {
  std::string title, subtitle, note, y_title, category_title;
  const std::vector<std::string>& categories;
  std::vector<LegendEntry> legend;
  /// The axis for a plot about this many pixels high.
  std::function<YAxis(double height)> axis;
};

/// Draws the frame around what `draw` draws on the plot; grid lines lie under it.
void drawInCategoryFrame(Canvas& canvas, const CategoryFrame& frame,
                         const std::function<void(const Box& plot, const YAxis& axis)>& draw);

/// The sign of a legend entry, in `box`.
void drawKey(Canvas& canvas, Key key, const Box& box, Colour colour);
/// A square on its corner, with a pale rim that sets it off from what lies under it.
void drawDiamond(Canvas& canvas, Spot centre, double radius, Colour colour);
/// A round point; hollow ones are filled with paper.
void drawPoint(Canvas& canvas, Spot centre, double radius, Colour colour, bool hollow);
/// A triangle whose tip is at `tip`, pointing up or down: the drawing goes on beyond the axis.
void drawArrowMark(Canvas& canvas, Spot tip, double size, Colour colour, bool upwards);
/// A line between two heights at `x`, with a cap at each end that is wanted.
void drawWhisker(Canvas& canvas, double x, double from, double to, double cap, Colour colour, bool cap_from,
                 bool cap_to);
/// An arrow as long as stated by its ends; its head takes at most `head` of it.
void drawArrow(Canvas& canvas, Spot from, Spot to, Colour colour, double width, double head);
/// Between the paper and `colour`, for the inside of boxes.
Colour paler(Colour colour, double share, Colour paper = colours::kPaper);

}  // namespace stiffscope::render
