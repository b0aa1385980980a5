#include "render/vtk/painters.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "render/vtk/chart_frame.h"
#include "render/vtk/offscreen_picture.h"

namespace stiffscope::render {

namespace {

constexpr Colour kDot = colours::kSeries[0], kMarkedDot = colours::kSeries[1];
constexpr std::size_t kMostGroups = 12;  // more columns leave no room for the sizes

void requireConsistent(const DotRowChart& chart) {
  if (chart.rows.empty())
    throw std::invalid_argument(fmt::format("dot chart '{}' has no row, expected one at least", chart.title));
  for (const auto& group : chart.groups) {
    const bool there =
        std::all_of(group.begin(), group.end(), [&](std::size_t row) { return row < chart.rows.size(); });
    if (!there || group.size() < 2) {
      throw std::invalid_argument(fmt::format("dot chart '{}': a group of rows {}, expected two or more of {}",
                                              chart.title, fmt::join(group, ", "), chart.rows.size()));
    }
  }
}

bool hasDot(const DotRow& row) { return std::isfinite(row.size) && row.size > 0.0; }

/// Where things stand: names, columns of groups, and the plot; rows from its top to its bottom.
struct RowFrame {
  double names = 0, columns = 0, column = 0;  ///< left edges; width of a column
  std::size_t groups = 0;
  Box plot;
  double row = 0;
  double lower = 1, upper = 10;  ///< of the axis

  double yOf(std::size_t i) const { return plot.top + (static_cast<double>(i) + 0.5) * row; }
  double xOf(double size) const { return plot.left + std::log(size / lower) / std::log(upper / lower) * plot.width(); }
  double xOfGroup(std::size_t g) const { return columns + (static_cast<double>(g) + 0.5) * column; }
};

TextStyle nameStyle(const Canvas& canvas, const DotRow& row) {
  TextStyle style = labelStyle(canvas);
  style.bold = row.marked;
  return style;
}

/// The axis over all sizes, with room for the number at the right of the last dot.
void fitAxis(const DotRowChart& chart, RowFrame& frame) {
  double least = INFINITY, most = 0.0;
  const auto include = [&](double size) {
    if (!std::isfinite(size) || size <= 0.0) return;
    least = std::min(least, size);
    most = std::max(most, size);
  };
  for (const DotRow& row : chart.rows) include(row.size);
  include(chart.reference);
  if (most == 0.0) return;
  const YAxis axis = logAxis(0.8 * least, most);
  constexpr double kRoom = 0.12;  // of the axis' length
  frame.lower = axis.lower;
  frame.upper = axis.upper * std::pow(axis.upper / axis.lower, kRoom);
}

RowFrame frameOf(const Canvas& canvas, const DotRowChart& chart, const Box& free, double head) {
  const double u = canvas.unit();
  RowFrame frame;
  double widest = 0;
  for (const DotRow& row : chart.rows) widest = std::max(widest, canvas.measure(row.name, nameStyle(canvas, row)).x);
  frame.names = free.left;
  frame.columns = free.left + std::min(widest, 0.3 * free.width()) + 14 * u;
  frame.groups = std::min(chart.groups.size(), kMostGroups);
  frame.column = 30 * u;
  // The title over the columns may be wider than they are.
  const double columns = frame.groups == 0 ? 0 : std::max(frame.column * static_cast<double>(frame.groups), 110 * u);
  frame.plot = {frame.columns + columns + 14 * u, free.top + head, free.right,
                free.bottom - 1.3 * labelStyle(canvas).size - 1.5 * axisTitleStyle(canvas).size};
  frame.row = frame.plot.height() / static_cast<double>(chart.rows.size());
  fitAxis(chart, frame);
  return frame;
}

void drawAxis(Canvas& canvas, const DotRowChart& chart, const RowFrame& frame) {
  const double u = canvas.unit();
  const TextStyle style = labelStyle(canvas), title = axisTitleStyle(canvas);
  const Ticks ticks = logTicks(frame.lower, frame.upper);
  double free_from = frame.plot.left - style.size;
  for (std::size_t i = 0; i < ticks.positions.size(); ++i) {
    const double x = Canvas::snapped(frame.xOf(ticks.positions[i]));
    canvas.fill({x - 0.5 * u, frame.plot.top, x + 0.5 * u, frame.plot.bottom}, colours::kGrid);
    const double half = canvas.measure(ticks.labels[i], style).x / 2;
    if (x - half < free_from) continue;
    if (x + half > frame.plot.right) break;
    canvas.text(ticks.labels[i], {x, frame.plot.bottom + 6 * u}, AlignX::centre, AlignY::top, style);
    free_from = x + half + 10 * u;
  }
  canvas.fill({frame.plot.left, frame.plot.bottom - u, frame.plot.right, frame.plot.bottom}, colours::kAxis);
  canvas.text(canvas.shortened(chart.x_title, frame.plot.width(), title),
              {frame.plot.middleX(), frame.plot.bottom + 8 * u + 1.2 * style.size}, AlignX::centre, AlignY::top, title);
}

void drawGroups(Canvas& canvas, const DotRowChart& chart, const RowFrame& frame) {
  const double u = canvas.unit(), radius = std::min(6 * u, 0.3 * frame.row);
  for (std::size_t g = 0; g < frame.groups; ++g) {
    const double x = frame.xOfGroup(g);
    const auto [first, last] = std::minmax_element(chart.groups[g].begin(), chart.groups[g].end());
    for (std::size_t i = 0; i < chart.rows.size(); ++i) canvas.disc({x, frame.yOf(i)}, 0.45 * radius, colours::kNone);
    canvas.line({x, frame.yOf(*first)}, {x, frame.yOf(*last)}, colours::kInk, 3 * u);
    for (const std::size_t row : chart.groups[g]) canvas.disc({x, frame.yOf(row)}, radius, colours::kInk);
  }
}

void drawRow(Canvas& canvas, const RowFrame& frame, const DotRow& row, double y, Colour ground) {
  const double u = canvas.unit(), radius = std::min(7 * u, 0.32 * frame.row);
  const TextStyle style = nameStyle(canvas, row);
  canvas.text(canvas.shortened(row.name, frame.columns - frame.names - 14 * u, style), {frame.names, y}, AlignX::left,
              AlignY::centre, style);
  if (!hasDot(row)) {
    TextStyle faint = labelStyle(canvas);
    faint.colour = canvas.palette().faint_ink;
    const std::string words = canvas.shortened(row.words, frame.plot.width() - 16 * u, faint);
    const Spot extent = canvas.measure(words, faint);
    // Over grid and reference line, which would strike the words through.
    canvas.fill({frame.plot.left + 4 * u, y - extent.y / 2, frame.plot.left + 12 * u + extent.x, y + extent.y / 2},
                ground);
    canvas.text(words, {frame.plot.left + 8 * u, y}, AlignX::left, AlignY::centre, faint);
    return;
  }
  const double x = frame.xOf(row.size);
  const Colour colour = row.marked ? kMarkedDot : kDot;
  canvas.mark({x, y}, "", row.name, row.size);
  canvas.line({frame.plot.left, y}, {x, y}, colour, 2 * u);
  if (row.marked)
    drawDiamond(canvas, {x, y}, 1.35 * radius, colour);
  else
    drawPoint(canvas, {x, y}, radius, colour, false);
  const std::string number = fmt::format("{:.{}f}", row.size, row.size < 9.95 ? 1 : 0);
  const double beside = std::min(x + 1.35 * radius + 7 * u, frame.plot.right - canvas.measure(number, style).x);
  canvas.text(number, {beside, y}, AlignX::left, AlignY::centre, style);
}

std::vector<LegendEntry> legendOf(const DotRowChart& chart) {
  const bool any_marked =
      std::any_of(chart.rows.begin(), chart.rows.end(), [](const DotRow& row) { return row.marked && hasDot(row); });
  std::vector<LegendEntry> legend{{Key::point, kDot, chart.dot_name}};
  if (any_marked) legend.push_back({Key::diamond, kMarkedDot, chart.marked_name});
  if (std::isfinite(chart.reference)) legend.push_back({Key::dashes, colours::kInk, chart.reference_name});
  return legend;
}

void paintChart(Canvas& canvas, const DotRowChart& chart) {
  const double u = canvas.unit();
  Box free = canvas.all();
  takeMargin(canvas, free);
  takeHeader(canvas, free, chart.title, chart.subtitle);
  takeLegend(canvas, free, legendOf(chart));
  if (chart.groups.size() > kMostGroups)
    takeNote(canvas, free, fmt::format("{} of {} groups are drawn.", kMostGroups, chart.groups.size()));
  const TextStyle style = labelStyle(canvas);
  const std::vector<std::string> over =
      chart.groups.empty() ? std::vector<std::string>{} : canvas.wrapped(chart.group_title, 130 * u, style);
  const double line = canvas.measure("0", style).y;
  const RowFrame frame = frameOf(canvas, chart, free, line * static_cast<double>(over.size()) + 8 * u);
  for (std::size_t i = 0; i < over.size(); ++i)
    canvas.text(over[i], {frame.columns, free.top + static_cast<double>(i) * line}, AlignX::left, AlignY::top, style);
  for (std::size_t i = 0; i < chart.rows.size(); i += 2)
    canvas.fill({frame.names, frame.yOf(i) - frame.row / 2, frame.plot.right, frame.yOf(i) + frame.row / 2},
                colours::kBand);
  drawAxis(canvas, chart, frame);
  if (std::isfinite(chart.reference) && chart.reference > 0.0) {
    const double x = frame.xOf(chart.reference);
    canvas.line({x, frame.plot.top}, {x, frame.plot.bottom}, colours::kInk, 1.75 * u, 6 * u);
  }
  drawGroups(canvas, chart, frame);
  for (std::size_t i = 0; i < chart.rows.size(); ++i)
    drawRow(canvas, frame, chart.rows[i], frame.yOf(i), i % 2 == 0 ? colours::kBand : colours::kPaper);
}

}  // namespace

Image drawDotRows(const DotRowChart& chart, Size size) {
  requireConsistent(chart);
  return drawFlat(size, [&chart](Canvas& canvas) { paintChart(canvas, chart); });
}

}  // namespace stiffscope::render
