#include "render/vtk/painters.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/spread_chart.h"
#include "render/vtk/chart_frame.h"
#include "render/vtk/offscreen_picture.h"

namespace stiffscope::render {

struct ValueRange {
  double lower = 0;
  double upper = 1;
};

/// Throws std::invalid_argument, as spread_chart.h says, with the offending numbers.
void requireConsistent(const SpreadChart& chart);
/// What the axis of `panel` covers, by the rule of spread_chart.h.
ValueRange rangeOf(const SpreadPanel& panel);
/// What the boxes are, and, where something was cut off, what the arrows mean.
std::string noteOn(const SpreadChart& chart, const std::vector<ValueRange>& ranges);

void requireConsistent(const SpreadChart& chart) {
  if (chart.methods.empty() || chart.panels.empty()) {
    throw std::invalid_argument(
        fmt::format("spread chart '{}' has {} methods and {} panels, expected one of each at least", chart.title,
                    chart.methods.size(), chart.panels.size()));
  }
  for (const SpreadPanel& panel : chart.panels) {
    const bool references_fit = panel.references.empty() || panel.references.size() == chart.methods.size();
    if (panel.spreads.size() != chart.methods.size() || !references_fit) {
      throw std::invalid_argument(
          fmt::format("spread chart '{}': panel '{}' has {} spreads and {} references for {} methods", chart.title,
                      panel.title, panel.spreads.size(), panel.references.size(), chart.methods.size()));
    }
    for (const auto& spread : panel.spreads) {
      if (!spread) continue;
      const std::array p = {spread->p5, spread->p25, spread->p50, spread->p75, spread->p95};
      const bool finite =
          std::isfinite(spread->mean) && std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x); });
      if (!finite || !std::is_sorted(p.begin(), p.end())) {
        throw std::invalid_argument(
            fmt::format("spread chart '{}': panel '{}' has percentiles {} {} {} {} {} and mean {}, "
                        "expected finite numbers, the percentiles in order",
                        chart.title, panel.title, p[0], p[1], p[2], p[3], p[4], spread->mean));
      }
    }
  }
}

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

namespace {

std::vector<ValueRange> rangesOf(const SpreadChart& chart) {
  std::vector<ValueRange> ranges;
  for (const SpreadPanel& panel : chart.panels) ranges.push_back(rangeOf(panel));
  if (chart.axis == SpreadAxis::shared) {
    ValueRange all = ranges[0];
    for (const ValueRange& range : ranges) all = {std::min(all.lower, range.lower), std::max(all.upper, range.upper)};
    ranges.assign(ranges.size(), all);
  }
  return ranges;
}

bool meanOff(const std::optional<Spread>& spread, const ValueRange& range, bool upwards) {
  return spread && (upwards ? spread->mean > range.upper : spread->mean < range.lower);
}

struct Column {
  double x;
  double half;
};

void drawBox(Canvas& canvas, const Column& column, const YAxis& axis, const Spread& spread, Colour colour) {
  const double u = canvas.unit();
  const double x = column.x, half = column.half;
  const auto at = [&axis](double value) { return axis.at(std::clamp(value, axis.lower, axis.upper)); };
  drawWhisker(canvas, x, at(spread.p75), at(spread.p95), half / 2, colour, false, axis.shows(spread.p95));
  drawWhisker(canvas, x, at(spread.p25), at(spread.p5), half / 2, colour, false, axis.shows(spread.p5));
  const Box box{x - half, at(spread.p75), x + half, std::max(at(spread.p25), at(spread.p75) + 2 * u)};
  canvas.fill(box, paler(colour, 0.45));
  canvas.outline(box, colour, std::min(1.5 * u, box.height() / 2));
  if (axis.shows(spread.p50)) canvas.line({box.left, at(spread.p50)}, {box.right, at(spread.p50)}, colour, 3 * u);
  if (axis.shows(spread.mean)) drawDiamond(canvas, {x, at(spread.mean)}, 5 * u, colour);
  if (!axis.shows(spread.p95) || spread.mean > axis.upper) {
    drawArrowMark(canvas, {x, axis.top}, 11 * u, colour, true);
  }
  if (!axis.shows(spread.p5) || spread.mean < axis.lower) {
    drawArrowMark(canvas, {x, axis.bottom}, 11 * u, colour, false);
  }
}

// Means that lie off the axis, one under the other, in the strip kept free for them at the edge.
void printMeansOff(Canvas& canvas, const Box& plot, double first, const SpreadChart& chart, const SpreadPanel& panel,
                   const ValueRange& range, bool upwards) {
  TextStyle style = noteStyle(canvas);
  for (std::size_t m = 0; m < panel.spreads.size(); ++m) {
    if (!meanOff(panel.spreads[m], range, upwards)) continue;
    style.colour = chart.methods[m].colour;
    canvas.text("mean " + shortNumber(panel.spreads[m]->mean), {plot.middleX(), first}, AlignX::centre, AlignY::top,
                style);
    first += 1.25 * style.size;
  }
}

double stripHeight(const Canvas& canvas, const SpreadChart& chart, const std::vector<ValueRange>& ranges,
                   bool upwards) {
  std::ptrdiff_t most = 0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto& spreads = chart.panels[i].spreads;
    most = std::max(most, std::count_if(spreads.begin(), spreads.end(),
                                        [&](const auto& spread) { return meanOff(spread, ranges[i], upwards); }));
  }
  return static_cast<double>(most) * 1.25 * noteStyle(canvas).size;
}

void drawPanel(Canvas& canvas, Box cell, const SpreadChart& chart, std::size_t index, const ValueRange& range,
               double strip_above, double strip_below) {
  const double u = canvas.unit();
  const SpreadPanel& panel = chart.panels[index];
  TextStyle title = axisTitleStyle(canvas);
  title.bold = true;
  const double title_height = canvas.measure("0", title).y;
  Box plot{cell.left, cell.top + title_height + strip_above + 6 * u, cell.right, cell.bottom - strip_below - 8 * u};
  YAxis axis = linearAxis(canvas, range.lower, range.upper, plot.height(), false);
  plot.left = Canvas::snapped(plot.left + tickLabelWidth(canvas, axis));
  canvas.text(canvas.shortened(panel.title, plot.width(), title), {plot.middleX(), cell.top}, AlignX::centre,
              AlignY::top, title);
  drawYAxis(canvas, plot, axis);
  canvas.fill({plot.left, plot.bottom - 0.5 * u, plot.right, plot.bottom + 0.5 * u}, colours::kAxis);
  if (axis.lower < 0 && axis.upper > 0) {
    canvas.fill({plot.left, axis.at(0) - 0.5 * u, plot.right, axis.at(0) + 0.5 * u}, colours::kAxis);
  }

  const double band = plot.width() / static_cast<double>(chart.methods.size());
  for (std::size_t m = 0; m < chart.methods.size(); ++m) {
    const Column column{plot.left + (static_cast<double>(m) + 0.5) * band, std::min(0.3 * band, 36 * u)};
    if (panel.spreads[m]) {
      drawBox(canvas, column, axis, *panel.spreads[m], chart.methods[m].colour);
      const double median = std::clamp(panel.spreads[m]->p50, axis.lower, axis.upper);
      canvas.mark({column.x, axis.at(median)}, chart.methods[m].name + ", median", panel.title, panel.spreads[m]->p50);
    } else {
      canvas.text("none", {column.x, plot.bottom - 3 * u}, AlignX::centre, AlignY::bottom, noteStyle(canvas));
    }
    if (panel.spreads[m] && m < panel.references.size() && panel.references[m] && axis.shows(*panel.references[m])) {
      const double y = axis.at(*panel.references[m]);
      canvas.line({column.x - 0.48 * band, y}, {column.x + 0.48 * band, y}, colours::kInk, 1.75 * u, 5 * u);
    }
  }
  printMeansOff(canvas, plot, cell.top + title_height + 2 * u, chart, panel, range, true);
  printMeansOff(canvas, plot, plot.bottom + 4 * u, chart, panel, range, false);
}

void paintChart(Canvas& canvas, const SpreadChart& chart) {
  const std::vector<ValueRange> ranges = rangesOf(chart);
  Box free = canvas.all();
  takeMargin(canvas, free);
  takeHeader(canvas, free, chart.title, chart.subtitle);
  std::vector<LegendEntry> legend;
  for (const SpreadMethod& method : chart.methods) legend.push_back({Key::square, method.colour, method.name});
  legend.push_back({Key::median, colours::kFaintInk, "median"});
  legend.push_back({Key::diamond, colours::kFaintInk, "mean"});
  legend.push_back({Key::dashes, colours::kInk, chart.reference_name});
  takeLegend(canvas, free, legend);
  takeNote(canvas, free, noteOn(chart, ranges));
  const double title_left = free.left;
  const std::vector<std::string> y_title = takeYTitle(canvas, free, chart.y_title);
  drawYTitle(canvas, title_left, free, y_title);

  const std::size_t count = chart.panels.size();
  const std::size_t rows = count > 6 ? (count > 14 ? 3 : 2) : 1;
  const std::size_t columns = (count + rows - 1) / rows;
  const double gap = 10 * canvas.unit();
  const double width = (free.width() + gap) / static_cast<double>(columns);
  const double height = (free.height() + gap) / static_cast<double>(rows);
  const double above = stripHeight(canvas, chart, ranges, true);
  const double below = stripHeight(canvas, chart, ranges, false);
  for (std::size_t i = 0; i < count; ++i) {
    const double left = free.left + static_cast<double>(i % columns) * width;
    const double top = free.top + static_cast<double>(i / columns) * height;
    drawPanel(canvas, {left, top, left + width - gap, top + height - gap}, chart, i, ranges[i], above, below);
  }
}

}  // namespace

Image drawSpreads(const SpreadChart& chart, Size size) {
  requireConsistent(chart);
  return drawFlat(size, [&chart](Canvas& canvas) { paintChart(canvas, chart); });
}

}  // namespace stiffscope::render
