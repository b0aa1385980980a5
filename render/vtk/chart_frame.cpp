#include "render/vtk/chart_frame.h"

#include <algorithm>
#include <cmath>

// What stands around the plots: title, legend, note, title of the y axis.

namespace stiffscope::render {

double YAxis::at(double value) const {
  const double share =
      logarithmic ? std::log(value / lower) / std::log(upper / lower) : (value - lower) / (upper - lower);
  return bottom + share * (top - bottom);
}

bool YAxis::shows(double value) const {
  const double inflation = 1e-9 * (upper - lower);
  return value >= lower - (logarithmic ? 0 : inflation) && value <= upper + inflation;
}

YAxis linearAxis(const Canvas& canvas, double lower, double upper, double height, bool widen) {
  if (!(upper > lower)) {
    const double around = lower != 0 ? std::abs(lower) / 2 : 1;
    lower -= around;
    upper += around;
  }
  const int most = std::max(3, static_cast<int>(height / (46 * canvas.unit())));
  YAxis axis{lower, upper, false, linearTicks(lower, upper, most)};
  if (widen && axis.ticks.positions.size() > 1) {
    const double step = axis.ticks.positions[1] - axis.ticks.positions[0];
    axis.lower = std::floor(lower / step + 1e-9) * step;
    axis.upper = std::ceil(upper / step - 1e-9) * step;
    axis.ticks =
        linearTicks(axis.lower, axis.upper, static_cast<int>(std::lround((axis.upper - axis.lower) / step)) + 1);
  }
  return axis;
}

YAxis logAxis(double lower, double upper) {
  if (!(upper > lower)) upper = lower;
  // Some room, and never less than a third of a decade, or the ticks run out.
  double low = lower / 1.15, high = upper * 1.15;
  if (high / low < 2) {
    const double widen = std::sqrt(2 / (high / low));
    low /= widen;
    high *= widen;
  }
  return {low, high, true, logTicks(low, high)};
}

double tickLabelWidth(const Canvas& canvas, const YAxis& axis) {
  double widest = 0;
  for (const std::string& label : axis.ticks.labels) {
    widest = std::max(widest, canvas.measure(label, labelStyle(canvas)).x);
  }
  return widest + 8 * canvas.unit();
}

void drawYAxis(Canvas& canvas, const Box& plot, YAxis& axis) {
  axis.top = plot.top;
  axis.bottom = plot.bottom;
  const double u = canvas.unit();
  const TextStyle style = labelStyle(canvas);
  double free_from = plot.bottom + style.size;
  for (std::size_t i = 0; i < axis.ticks.positions.size(); ++i) {
    const double y = Canvas::snapped(axis.at(axis.ticks.positions[i]));
    canvas.fill({plot.left, y - 0.5 * u, plot.right, y + 0.5 * u}, colours::kGrid);
    // Ticks of a logarithmic axis crowd towards the top of each decade.
    if (y + 0.5 * style.size > free_from) continue;
    canvas.text(axis.ticks.labels[i], {plot.left - 8 * u, y}, AlignX::right, AlignY::centre, style);
    free_from = y - 0.5 * style.size;
  }
  canvas.fill({plot.left - u, plot.top, plot.left, plot.bottom}, colours::kAxis);
}

CategoryLabels fitCategoryLabels(const Canvas& canvas, const std::vector<std::string>& categories, double band,
                                 double room) {
  const TextStyle style = labelStyle(canvas);
  double widest = 0;
  std::size_t longest = 0;
  for (const std::string& category : categories) {
    widest = std::max(widest, canvas.measure(category, style).x);
    longest = std::max(longest, category.size());
  }
  const double apart = 8 * canvas.unit();
  CategoryLabels labels;
  labels.height = canvas.measure("0", style).y;
  const auto bands = [band](double width) { return std::max(1, static_cast<int>(std::ceil(width / band))); };
  if (widest + apart <= band) return labels;
  // Numbers stay legible when only every second or fifth is written; names are wanted all, so they turn
  // first.
  if (longest <= 3) {
    labels.every = bands(widest + apart);
    if (labels.every > 2) labels.every = static_cast<int>(roundUp125(labels.every));
    return labels;
  }
  labels.direction = Direction::up;
  labels.every = bands(labels.height);
  labels.height = std::min(widest, room);
  return labels;
}

void drawCategories(Canvas& canvas, const Box& plot, const std::vector<std::string>& categories,
                    const CategoryLabels& labels, const std::string& title) {
  const double u = canvas.unit();
  const TextStyle style = labelStyle(canvas);
  const double band = plot.width() / static_cast<double>(categories.size());
  const double top = plot.bottom + 6 * u;
  for (std::size_t i = 0; i < categories.size(); i += static_cast<std::size_t>(labels.every)) {
    const double x = plot.left + (static_cast<double>(i) + 0.5) * band;
    if (labels.direction == Direction::up) {
      canvas.text(canvas.shortened(categories[i], labels.height, style), {x, top}, AlignX::centre, AlignY::top, style,
                  Direction::up);
    } else {
      canvas.text(categories[i], {x, top}, AlignX::centre, AlignY::top, style);
    }
  }
  if (title.empty()) return;
  const TextStyle title_style = axisTitleStyle(canvas);
  canvas.text(canvas.shortened(title, plot.width(), title_style), {plot.middleX(), top + labels.height + 4 * u},
              AlignX::centre, AlignY::top, title_style);
}

void drawInCategoryFrame(Canvas& canvas, const CategoryFrame& frame,
                         const std::function<void(const Box& plot, const YAxis& axis)>& draw) {
  const double u = canvas.unit();
  Box free = canvas.all();
  takeMargin(canvas, free);
  takeHeader(canvas, free, frame.title, frame.subtitle);
  takeLegend(canvas, free, frame.legend);
  takeNote(canvas, free, frame.note);
  const double title_left = free.left;
  const std::vector<std::string> y_title = takeYTitle(canvas, free, frame.y_title);

  YAxis axis = frame.axis(free.height() - 60 * u);
  Box plot = free;
  plot.left = Canvas::snapped(plot.left + tickLabelWidth(canvas, axis));
  const CategoryLabels labels = fitCategoryLabels(
      canvas, frame.categories, plot.width() / static_cast<double>(frame.categories.size()), 0.25 * free.height());
  plot.bottom -= labels.height + 10 * u + (frame.category_title.empty() ? 0 : 1.2 * axisTitleStyle(canvas).size);
  drawYTitle(canvas, title_left, plot, y_title);
  drawYAxis(canvas, plot, axis);
  draw(plot, axis);
  drawCategories(canvas, plot, frame.categories, labels, frame.category_title);
}

Colour paler(Colour colour, double share, Colour paper) {
  const auto mix = [share](double channel, double ground) {
    return static_cast<std::uint8_t>(std::lround(ground + share * (channel - ground)));
  };
  return {mix(colour.red, paper.red), mix(colour.green, paper.green), mix(colour.blue, paper.blue)};
}

void drawDiamond(Canvas& canvas, Spot c, double radius, Colour colour) {
  const auto diamond = [c](double r) {
    return std::vector<Spot>{{c.x, c.y - r}, {c.x + r, c.y}, {c.x, c.y + r}, {c.x - r, c.y}};
  };
  canvas.polygon(diamond(radius + 2 * canvas.unit()), canvas.palette().paper);
  canvas.polygon(diamond(radius), colour);
}

void drawPoint(Canvas& canvas, Spot centre, double radius, Colour colour, bool hollow) {
  canvas.disc(centre, radius, colour);
  if (hollow) canvas.disc(centre, 0.6 * radius, canvas.palette().paper);
}

void drawArrowMark(Canvas& canvas, Spot tip, double size, Colour colour, bool upwards) {
  const double base = tip.y + (upwards ? size : -size);
  canvas.polygon({tip, {tip.x - 0.6 * size, base}, {tip.x + 0.6 * size, base}}, colour);
}

void drawWhisker(Canvas& canvas, double x, double from, double to, double cap, Colour colour, bool cap_from,
                 bool cap_to) {
  const double width = 1.5 * canvas.unit();
  canvas.line({x, from}, {x, to}, colour, width);
  if (cap_from) canvas.line({x - cap, from}, {x + cap, from}, colour, width);
  if (cap_to) canvas.line({x - cap, to}, {x + cap, to}, colour, width);
}

void drawArrow(Canvas& canvas, Spot from, Spot to, Colour colour, double width, double head) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (!(length > 0)) return;
  head = std::min(head, 0.6 * length);
  const Spot along{(to.x - from.x) / length, (to.y - from.y) / length};
  const Spot neck{to.x - head * along.x, to.y - head * along.y};
  const double half = 0.4 * head;
  canvas.line(from, neck, colour, width);
  canvas.polygon(
      {to, {neck.x - half * along.y, neck.y + half * along.x}, {neck.x + half * along.y, neck.y - half * along.x}},
      colour);
}

void drawKey(Canvas& canvas, Key key, const Box& box, Colour colour) {
  const Spot centre{box.middleX(), box.middleY()};
  const double r = box.width() / 2;
  switch (key) {
    case Key::square:
      canvas.fill({box.left + 0.1 * r, box.top + 0.3 * r, box.right - 0.1 * r, box.bottom - 0.3 * r}, colour);
      break;
    case Key::point:
    case Key::hollow_point:
      drawPoint(canvas, centre, 0.55 * r, colour, key == Key::hollow_point);
      break;
    case Key::dashes:
      canvas.line({box.left, centre.y}, {box.right, centre.y}, colour, 2 * canvas.unit(), 0.37 * box.width());
      break;
    case Key::diamond:
      drawDiamond(canvas, centre, 0.55 * r, colour);
      break;
    case Key::median:
      canvas.line({box.left, centre.y}, {box.right, centre.y}, colour, 3 * canvas.unit());
      break;
    case Key::thick_arrow:
    case Key::medium_arrow:
    case Key::thin_arrow:
      drawArrow(canvas, {box.left - 0.4 * r, centre.y}, {box.right + 0.4 * r, centre.y}, colour,
                (key == Key::thick_arrow    ? 6
                 : key == Key::medium_arrow ? 3.5
                                            : 2.2) *
                    canvas.unit(),
                key == Key::thin_arrow ? r : 1.4 * r);
      break;
  }
}

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
    canvas.text(line, {free.left, free.top}, AlignX::left, AlignY::top, style);
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

namespace {

/// Goes through a legend in a room of this width: `visit` has the entry, its name as far as it fits, and where it
/// stands from the upper left. Returns the height.
template <class Visit>
double layLegend(const Canvas& canvas, double width, const std::vector<LegendEntry>& entries, const Visit& visit) {
  const double u = canvas.unit(), key = 18 * u, gap = 7 * u, apart = 24 * u, row = 22 * u;
  const TextStyle style = labelStyle(canvas);
  double x = 0, top = 0;
  bool any = false;
  for (const LegendEntry& entry : entries) {
    if (entry.name.empty()) continue;
    const std::string name = canvas.shortened(entry.name, width - key - gap, style);
    const double wide = key + gap + canvas.measure(name, style).x;
    if (x > 0 && x + wide > width) {
      x = 0;
      top += row;
    }
    visit(entry, name, Spot{x, top + row / 2}, key, gap);
    x += wide + apart;
    any = true;
  }
  return any ? top + row + 12 * u : 0;
}

}  // namespace

double legendHeight(const Canvas& canvas, double width, const std::vector<LegendEntry>& entries) {
  return layLegend(canvas, width, entries, [](const auto&...) {});
}

void takeLegend(Canvas& canvas, Box& free, const std::vector<LegendEntry>& entries) {
  const TextStyle style = labelStyle(canvas);
  const auto draw = [&](const LegendEntry& entry, const std::string& name, Spot at, double key, double gap) {
    const double x = free.left + at.x, y = free.top + at.y;
    drawKey(canvas, entry.key, {x, y - key / 2, x + key, y + key / 2}, entry.colour);
    canvas.text(name, {x + key + gap, y}, AlignX::left, AlignY::centre, style);
  };
  free.top += layLegend(canvas, free.width(), entries, draw);
}

void takeNote(Canvas& canvas, Box& free, const std::string& note) {
  if (note.empty()) return;
  const TextStyle style = noteStyle(canvas);
  const std::vector<std::string> lines = canvas.wrapped(note, free.width(), style);
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    canvas.text(*line, {free.left, free.bottom}, AlignX::left, AlignY::bottom, style);
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
    canvas.text(line, {left, top}, AlignX::left, AlignY::top, style, Direction::up);
    left += canvas.measure(line, style).y;
  }
}

// A report shows a picture of 1200 pixels about 700 wide, and prints it 16 cm wide: 17 pixels are then 10 on the screen
// and 6.5 points on paper.

TextStyle titleStyle(const Canvas& canvas) { return {24 * canvas.unit(), true, canvas.palette().ink}; }
TextStyle subtitleStyle(const Canvas& canvas) { return {17 * canvas.unit(), false, canvas.palette().faint_ink}; }
TextStyle axisTitleStyle(const Canvas& canvas) { return {18.5 * canvas.unit(), false, canvas.palette().ink}; }
TextStyle labelStyle(const Canvas& canvas) { return {17 * canvas.unit(), false, canvas.palette().ink}; }
TextStyle noteStyle(const Canvas& canvas) { return {15 * canvas.unit(), false, canvas.palette().faint_ink}; }

}  // namespace stiffscope::render
