// What stands around the plots: title, legend, note, title of the y axis.
#include <algorithm>

#include "render/vtk/chart_frame.h"
#include "render/vtk/marks.h"

namespace stiffscope {

void takeMargin(const Canvas& canvas, Box& free) {
  const double margin = 16 * canvas.unit();
  free = {free.left + margin, free.top + 0.8 * margin, free.right - margin, free.bottom - 0.7 * margin};
}

namespace {

/// At most two lines: the names of a campaign are not ours, and the plot must keep its room.
void takeLines(Canvas& canvas, Box& free, const std::string& text, const TextStyle& style) {
  constexpr std::size_t kMostLines = 2;
  std::vector<std::string> lines = canvas.wrapped(text, free.width(), style);
  if (lines.size() > kMostLines) {
    lines.resize(kMostLines);
    lines.back() = canvas.shortened(lines.back() + " \u2026", free.width(), style);
  }
  for (const std::string& line : lines) {
    canvas.text(line, {free.left, free.top}, AlignX::Left, AlignY::Top, style);
    free.top += canvas.measure(line, style).y;
  }
}

}  // namespace

void takeHeader(Canvas& canvas, Box& free, const std::string& title, const std::string& subtitle) {
  takeLines(canvas, free, title, titleStyle(canvas));
  if (!subtitle.empty()) {
    free.top += 4 * canvas.unit();
    takeLines(canvas, free, subtitle, subtitleStyle(canvas));
  }
  free.top += 8 * canvas.unit();
}

void takeLegend(Canvas& canvas, Box& free, const std::vector<LegendEntry>& entries) {
  const double u = canvas.unit();
  const TextStyle style = labelStyle(canvas);
  const double key = 18 * u, gap = 7 * u, apart = 24 * u, row = 22 * u;
  double x = free.left;
  bool any = false;
  for (const LegendEntry& entry : entries) {
    if (entry.name.empty()) continue;
    const std::string name = canvas.shortened(entry.name, free.width() - key - gap, style);
    const double width = key + gap + canvas.measure(name, style).x;
    if (x > free.left && x + width > free.right) {
      x = free.left;
      free.top += row;
    }
    const double y = free.top + row / 2;
    drawKey(canvas, entry.key, {x, y - key / 2, x + key, y + key / 2}, entry.colour);
    canvas.text(name, {x + key + gap, y}, AlignX::Left, AlignY::Centre, style);
    x += width + apart;
    any = true;
  }
  if (any) free.top += row + 12 * u;
}

void takeNote(Canvas& canvas, Box& free, const std::string& note) {
  if (note.empty()) return;
  const TextStyle style = noteStyle(canvas);
  const std::vector<std::string> lines = canvas.wrapped(note, free.width(), style);
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    canvas.text(*line, {free.left, free.bottom}, AlignX::Left, AlignY::Bottom, style);
    free.bottom -= canvas.measure(*line, style).y;
  }
  free.bottom -= 6 * canvas.unit();
}

std::vector<std::string> takeYTitle(const Canvas& canvas, Box& free, const std::string& title) {
  if (title.empty()) return {};
  const TextStyle style = axisTitleStyle(canvas);
  // The plot is going to be lower than the room, by its category labels.
  std::vector<std::string> lines = canvas.wrapped(title, 0.8 * free.height(), style);
  free.left += static_cast<double>(lines.size()) * canvas.measure("0", style).y + 6 * canvas.unit();
  return lines;
}

void drawYTitle(Canvas& canvas, double left, const Box& plot, const std::vector<std::string>& lines) {
  const TextStyle style = axisTitleStyle(canvas);
  for (const std::string& line : lines) {
    // A title longer than the plot is high leans to the bottom of the picture, where there is room.
    const double top = std::max(plot.middleY() - canvas.measure(line, style).x / 2, plot.top);
    canvas.text(line, {left, top}, AlignX::Left, AlignY::Top, style, Direction::Up);
    left += canvas.measure(line, style).y;
  }
}

}  // namespace stiffscope
