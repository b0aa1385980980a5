#include <algorithm>
#include <cmath>

#include "render/vtk/chart_frame.h"

namespace stiffscope {

double YAxis::at(double value) const {
  const double share =
      logarithmic ? std::log(value / lower) / std::log(upper / lower) : (value - lower) / (upper - lower);
  return bottom + share * (top - bottom);
}

bool YAxis::shows(double value) const {
  const double slack = 1e-9 * (upper - lower);
  return value >= lower - (logarithmic ? 0 : slack) && value <= upper + slack;
}

YAxis linearAxis(const Canvas& canvas, double lower, double upper, double height, bool widen) {
  if (!(upper > lower)) {
    const double around = lower != 0 ? std::abs(lower) / 2 : 1;
    lower -= around;
    upper += around;
  }
  const int most = std::max(3, static_cast<int>(height / (46 * canvas.unit())));
  YAxis axis{lower, upper, false, linearTicks(lower, upper, most)};
  // One tick tells no scale.
  for (int more = most + 1; axis.ticks.positions.size() < 2 && more < most + 4; ++more)
    axis.ticks = linearTicks(lower, upper, more);
  if (widen && axis.ticks.positions.size() > 1) {
    const double step = axis.ticks.positions[1] - axis.ticks.positions[0];
    axis.lower = std::floor(lower / step + 1e-9) * step;
    axis.upper = std::ceil(upper / step - 1e-9) * step;
    axis.ticks = linearTicks(axis.lower, axis.upper,
                             static_cast<int>(std::lround((axis.upper - axis.lower) / step)) + 1);
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
    canvas.text(axis.ticks.labels[i], {plot.left - 8 * u, y}, AlignX::Right, AlignY::Centre, style);
    free_from = y - 0.5 * style.size;
  }
  canvas.fill({plot.left - u, plot.top, plot.left, plot.bottom}, colours::kAxis);
}

CategoryLabels fitCategoryLabels(const Canvas& canvas, const std::vector<std::string>& categories,
                                 double band, double room) {
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
  labels.direction = Direction::Up;
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
    if (labels.direction == Direction::Up) {
      canvas.text(canvas.shortened(categories[i], labels.height, style), {x, top}, AlignX::Centre,
                  AlignY::Top, style, Direction::Up);
    } else {
      canvas.text(categories[i], {x, top}, AlignX::Centre, AlignY::Top, style);
    }
  }
  if (title.empty()) return;
  const TextStyle title_style = axisTitleStyle(canvas);
  canvas.text(canvas.shortened(title, plot.width(), title_style),
              {plot.middleX(), top + labels.height + 4 * u}, AlignX::Centre, AlignY::Top, title_style);
}

}  // namespace stiffscope
