#include "app/figures/sweep_circles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/figures/drawn_words.h"
#include "app/figures/series_look.h"
#include "core/diagnosis/evenly_spread.h"
#include "core/input/units.h"
#include "render/ticks.h"
#include "reports/page/html.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

constexpr std::size_t kMostOnRing = 60;  // a mark is eight pixels wide, a ring some six hundred long

/// Radial residual of one reading, at the joint's angle.
struct RadialResidual {
  double angle = 0.0;  // rad
  double residual = 0.0;
};

std::vector<RadialResidual> residualsOn(const ReportCampaign& one, const RigidPoints& points, int axis,
                                        std::size_t ring) {
  const MeasuredAxis& measured = one.identification.frames.axes[static_cast<std::size_t>(axis)];
  const Line& line = measured.fit.axis.line;
  std::vector<RadialResidual> residuals;
  const auto& rows = one.campaign.circle_sweeps->rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].axis != axis || rows[i].target != measured.targets[ring]) continue;
    const double radius = (points.circle_sweeps[i] - line.point).cross(line.direction).norm();
    residuals.push_back({rows[i].q[axis], radius - measured.fit.circles[ring].radius});
  }
  std::sort(residuals.begin(), residuals.end(),
            [](const RadialResidual& a, const RadialResidual& b) { return a.angle < b.angle; });
  return residuals;
}

PlotPoint polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

PointSeries fullRing(double radius) {
  PointSeries ring;
  ring.colour = colours::kAxis;
  ring.mark = PointMark::None;
  ring.joined = true;
  constexpr int kCorners = 120;
  for (int i = 0; i <= kCorners; ++i) ring.points.push_back(polar(radius, 2.0 * std::numbers::pi * i / kCorners));
  return ring;
}

/// `most`: the most readings of any ring so far.
ShapePanel circlePanel(const ReportCampaign& one, const RigidPoints& points, int axis, std::size_t& most) {
  const MeasuredAxis& measured = one.identification.frames.axes[static_cast<std::size_t>(axis)];
  const std::size_t rings = measured.targets.size();
  std::vector<std::vector<RadialResidual>> residuals;
  double largest = 0.0;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    residuals.push_back(residualsOn(one, points, axis, ring));
    most = std::max(most, residuals.back().size());
    for (const RadialResidual& at : residuals.back()) largest = std::max(largest, std::abs(at.residual));
  }
  const double apart = 1.0 / static_cast<double>(rings + 1);
  const double magnified = largest > 0.0 ? 0.45 * apart / largest : 1.0;  // rings do not touch
  ShapePanel panel;
  panel.title = fmt::format("Axis {}", axis + 1);
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double radius = 1.0 - apart * static_cast<double>(ring);
    panel.series.push_back(fullRing(radius));
    PointSeries series = seriesLook(static_cast<std::size_t>(measured.targets[ring]));
    series.name = page::pointName(one.campaign.targets[static_cast<std::size_t>(measured.targets[ring])].id);
    series.joined = true;
    for (const std::size_t i : evenlySpreadIndices(residuals[ring].size(), kMostOnRing)) {
      const RadialResidual& at = residuals[ring][i];
      series.points.push_back(polar(radius + magnified * at.residual, at.angle));
    }
    panel.series.push_back(std::move(series));
  }
  const double bar_um = roundUp125(std::max(1e-3, largest / kMicrometre));
  panel.scale_bar = magnified * bar_um * kMicrometre;
  panel.scale_name = fmt::format("{} µm", shortNumber(bar_um));
  return panel;
}

}  // namespace

std::optional<PointChart> sweepCircles(const ReportCampaign& one, const RigidPoints& points) {
  if (!one.campaign.circle_sweeps) return std::nullopt;
  PointChart chart;
  chart.title = "Circles of the axes with their radial residuals magnified";
  chart.subtitle = page::asIs(one.campaign.name);
  chart.note = "A ring a reflector; rings are not to scale, residuals are, by the bar. Angle zero is at the right.";
  chart.columns = 3;
  std::size_t most = 0;
  for (int axis = 0; axis < 6; ++axis) {
    if (one.identification.frames.axes[static_cast<std::size_t>(axis)].measured)
      chart.shapes.push_back(circlePanel(one, points, axis, most));
  }
  chart.note += drawnWords(most, kMostOnRing, "readings of the longest ring");
  if (chart.shapes.empty()) return std::nullopt;
  return chart;
}

Figure describeSweepCircles(const ReportCampaign& one) {
  double worst = 0.0;
  std::size_t at = 0;
  const auto& axes = one.identification.frames.axes;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    if (axes[axis].measured && axes[axis].fit.rms > worst) worst = axes[axis].fit.rms, at = axis;
  }
  Figure figure;
  figure.id = "circles";
  figure.title = "Circles of the axes";
  figure.caption = fmt::format(
      "Radial residuals of the circle-point fits against the joint's angle. The largest rms, radial and axial, is "
      "{}\u00a0µm, of axis {}. Scatter is noise; a ring that is bent the same way for all reflectors is an axis that "
      "moves as it turns.",
      page::significant(worst / kMicrometre, 2), at + 1);
  figure.alt = "Rings by axis and reflector: readings of the sweeps about the fitted circles, residuals magnified.";
  return figure;
}

}  // namespace stiffscope
