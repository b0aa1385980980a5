#include "app/figures/figures.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/figures/chart_series.h"
#include "app/figures/chart_style.h"
#include "core/io/units.h"
#include "core/preparation/subsample.h"
#include "render/ticks.h"
#include "reports/page/html.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"

namespace stiffscope::app {

frames::RigidPoints rigidSweeps(const reports::ReportCampaign& one) {
  const frames::Frames& frames = one.identification.frames;
  const auto shown = reports::shownMethod(one.identification);
  if (!frames.sag_removed || !shown) return frames::rigidPoints(one.campaign, {});
  return frames::rigidPoints(one.campaign, frames::sagOf(frames, one.identification.of(*shown).geometry.compliance));
}

namespace {

constexpr std::size_t kMostOnRing = 60;  // a mark is eight pixels wide, a ring some six hundred long

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kSameAngle = 1e-6;  // rad; far below what a controller tells apart

/// Radial residual of one reading, at the joint's angle.
struct RadialResidual {
  double angle = 0.0;  // rad
  double residual = 0.0;
};

std::vector<RadialResidual> residualsOn(const reports::ReportCampaign& one, const frames::RigidPoints& points, int axis,
                                        std::size_t ring) {
  const frames::MeasuredAxis& measured = one.identification.frames.axes[static_cast<std::size_t>(axis)];
  const metrology::Line& line = measured.fit.axis.line;
  std::vector<RadialResidual> residuals;
  const auto& rows = one.campaign.circle_sweeps->rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].axis != axis || rows[i].target != measured.targets[ring]) continue;
    const double radius = (points.circle_sweeps[i] - line.point).cross(line.direction).norm();
    residuals.push_back({rows[i].q[axis], radius - measured.fit.circles[ring].radius});
  }
  const auto byAngle = [](const RadialResidual& a, const RadialResidual& b) { return a.angle < b.angle; };
  std::sort(residuals.begin(), residuals.end(), byAngle);
  // A sweep that goes round more than once comes back to where it was: neighbours on the ring are not neighbours in q.
  if (!residuals.empty() && residuals.back().angle - residuals.front().angle > kTurn + kSameAngle) {
    for (RadialResidual& at : residuals) {
      at.angle -= kTurn * std::floor(at.angle / kTurn);
      if (at.angle > kTurn - kSameAngle) at.angle -= kTurn;  // 360 degrees less a rounding is zero
    }
    std::stable_sort(residuals.begin(), residuals.end(), byAngle);
  }
  return residuals;
}

render::PlotPoint polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

render::PointSeries fullRing(double radius) {
  render::PointSeries ring;
  ring.colour = render::colours::kAxis;
  ring.mark = render::PointMark::none;
  ring.joined = true;
  constexpr int kCorners = 120;
  for (int i = 0; i <= kCorners; ++i) ring.points.push_back(polar(radius, kTurn * i / kCorners));
  return ring;
}

/// The line through readings at `radius_of` their residual, along the ring: straight between few readings it would cut
/// across the other rings.
template <class RadiusOf>
std::vector<render::PlotPoint> alongRing(const std::vector<RadialResidual>& readings, const RadiusOf& radius_of) {
  constexpr double kStep = kTurn / 120.0;
  std::vector<render::PlotPoint> line;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double radius = radius_of(readings[i]);
    if (i > 0) {
      const double from = readings[i - 1].angle, by = readings[i].angle - from, start = radius_of(readings[i - 1]);
      const int parts = static_cast<int>(std::ceil(by / kStep));
      for (int k = 1; k < parts; ++k)
        line.push_back(polar(start + (radius - start) * k / parts, from + by * k / parts));
    }
    line.push_back(polar(radius, readings[i].angle));
  }
  return line;
}

/// `most`: the most readings of any ring so far.
render::ShapePanel circlePanel(const reports::ReportCampaign& one, const frames::RigidPoints& points, int axis,
                               std::size_t& most) {
  const frames::MeasuredAxis& measured = one.identification.frames.axes[static_cast<std::size_t>(axis)];
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
  const double bar = io::kMicrometre * render::roundUp125(std::max(1e-3, largest / io::kMicrometre));
  const reports::LengthUnit unit = reports::lengthUnit(bar);
  render::ShapePanel panel;
  panel.title = fmt::format("Axis {}", axis + 1);
  panel.value_name = fmt::format("Radial residual ({})", unit.name);
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double radius = 1.0 - apart * static_cast<double>(ring);
    panel.series.push_back(fullRing(radius));
    render::PointSeries series = seriesLook(static_cast<std::size_t>(measured.targets[ring]));
    series.name = reports::pointName(one.campaign.targets[static_cast<std::size_t>(measured.targets[ring])].id);
    std::vector<RadialResidual> shown;
    for (const std::size_t i : preparation::evenlySpreadIndices(residuals[ring].size(), kMostOnRing))
      shown.push_back(residuals[ring][i]);
    const auto radiusOf = [&](const RadialResidual& at) { return radius + magnified * at.residual; };
    for (const RadialResidual& at : shown) {
      series.points.push_back(polar(radiusOf(at), at.angle));
      series.values.push_back({at.residual / unit.size, at.angle / io::kDegree});
    }
    series.line = alongRing(shown, radiusOf);
    panel.series.push_back(std::move(series));
  }
  panel.scale_bar = magnified * bar;
  panel.scale_name = fmt::format("{} {}", render::shortNumber(bar / unit.size), unit.name);
  return panel;
}

}  // namespace

std::optional<render::PointChart> sweepCircles(const reports::ReportCampaign& one, const frames::RigidPoints& points) {
  if (!one.campaign.circle_sweeps) return std::nullopt;
  render::PointChart chart;
  chart.title = "Circles of the axes with their radial residuals magnified";
  chart.subtitle = reports::asIs(one.campaign.name);
  chart.note = "A ring a reflector; rings are not to scale, residuals are, by the bar. Angle zero is at the right.";
  chart.columns = 3;
  std::size_t most = 0;
  for (int axis = 0; axis < static_cast<int>(one.identification.frames.axes.size()); ++axis) {
    const frames::MeasuredAxis& measured = one.identification.frames.axes[static_cast<std::size_t>(axis)];
    if (measured.measured && !measured.fit.circles.empty())  // of coupled joints there are no circles
      chart.shapes.push_back(circlePanel(one, points, axis, most));
  }
  chart.note += drawnWords(most, kMostOnRing, "readings of the longest ring");
  if (chart.shapes.empty()) return std::nullopt;
  return chart;
}

reports::Figure describeSweepCircles(const reports::ReportCampaign& one) {
  double worst = 0.0;
  std::size_t at = 0;
  const auto& axes = one.identification.frames.axes;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    if (axes[axis].measured && axes[axis].fit.rms > worst) worst = axes[axis].fit.rms, at = axis;
  }
  reports::Figure figure;
  figure.id = "circles";
  figure.title = "Circles of the axes";
  figure.caption = fmt::format(
      "Radial residuals of the circle-point fits against the joint's angle. The largest rms, radial and axial, is "
      "{}, of axis {}. Scatter is noise; a ring that is bent the same way for all reflectors is an axis that "
      "moves as it turns.",
      reports::shownLength(worst, 2), at + 1);
  figure.category_name = "Angle of the joint (°)";
  figure.alt = "Rings by axis and reflector: readings of the sweeps about the fitted circles, residuals magnified.";
  return figure;
}

namespace {

constexpr std::size_t kMostReadings = 1000;  // of a reflector

struct SphereResidual {
  int target = 0;
  double azimuth_deg = 0.0, elevation_deg = 0.0, residual = 0.0;  // in the chart's unit
};

std::vector<SphereResidual> residualsOf(const reports::ReportCampaign& one, const frames::RigidPoints& points,
                                        const reports::LengthUnit& unit) {
  std::vector<SphereResidual> residuals;
  const frames::WristCentre& wrist = one.identification.frames.wrist;
  const auto r0_from_points = frames::r0FromTable(one.identification.frames, one.campaign.wrist_sweep->frame);
  if (!r0_from_points) return residuals;
  const auto& rows = one.campaign.wrist_sweep->rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector3d arm = *r0_from_points * points.wrist_sweep[i] - wrist.centre_in_r0;
    const double radius = wrist.radii[static_cast<std::size_t>(rows[i].target)];
    if (!std::isfinite(radius)) continue;
    residuals.push_back({rows[i].target, std::atan2(arm.y(), arm.x()) / io::kDegree,
                         std::asin(std::clamp(arm.z() / arm.norm(), -1.0, 1.0)) / io::kDegree,
                         (arm.norm() - radius) / unit.size});
  }
  return residuals;
}

/// Means over equal sectors of [lower, upper], joined.
render::PointSeries sectorMeans(const std::vector<SphereResidual>& residuals, double SphereResidual::*angle,
                                double lower, double upper, std::size_t sectors) {
  std::vector<render::PlotPoint> points;
  for (const SphereResidual& one : residuals) points.push_back({one.*angle, one.residual});
  render::PointSeries means = meansOver(points, lower, upper, sectors);
  means.name = "mean in sectors";
  return means;
}

render::PointPanel spherePanel(const reports::ReportCampaign& one, const std::vector<SphereResidual>& residuals,
                               double SphereResidual::*angle) {
  render::PointPanel panel;
  // Of each reflector by itself: where they take turns, every so many readings may be always the same one's.
  std::vector<std::vector<std::size_t>> readings(one.campaign.targets.size());
  for (std::size_t i = 0; i < residuals.size(); ++i)
    readings[static_cast<std::size_t>(residuals[i].target)].push_back(i);
  for (std::size_t target = 0; target < readings.size(); ++target) {
    render::PointSeries series = seriesLook(target);
    series.name = reports::pointName(one.campaign.targets[target].id);
    for (const std::size_t k : preparation::evenlySpreadIndices(readings[target].size(), kMostReadings)) {
      const SphereResidual& at = residuals[readings[target][k]];
      series.points.push_back({at.*angle, at.residual});
    }
    if (!series.points.empty()) panel.series.push_back(std::move(series));
  }
  return panel;
}

}  // namespace

std::optional<render::PointChart> wristSphere(const reports::ReportCampaign& one, const frames::RigidPoints& points) {
  if (!one.campaign.wrist_sweep || !one.identification.frames.wrist.measured) return std::nullopt;
  const reports::LengthUnit unit = reports::lengthUnit(one.identification.frames.wrist.spheres.rms);
  const std::vector<SphereResidual> residuals = residualsOf(one, points, unit);
  if (residuals.empty()) return std::nullopt;
  render::PointChart chart;
  chart.title = "Radial residuals of the wrist's spheres";
  chart.subtitle = reports::asIs(one.campaign.name);
  chart.columns = 2;
  render::PointPanel azimuth = spherePanel(one, residuals, &SphereResidual::azimuth_deg);
  azimuth.series.push_back(sectorMeans(residuals, &SphereResidual::azimuth_deg, -180.0, 180.0, 18));
  azimuth.x_title = "Azimuth about P_{wrist} (°)";
  azimuth.y_title = fmt::format("Radial residual ({})", unit.name);
  render::PointPanel elevation = spherePanel(one, residuals, &SphereResidual::elevation_deg);
  elevation.series.push_back(sectorMeans(residuals, &SphereResidual::elevation_deg, -90.0, 90.0, 9));
  elevation.x_title = "Elevation (°)";
  chart.diagrams = {std::move(azimuth), std::move(elevation)};
  return chart;
}

reports::Figure describeWristSphere(const reports::ReportCampaign& one) {
  const frames::WristCentre& wrist = one.identification.frames.wrist;
  reports::Figure figure;
  figure.id = "wrist-sphere";
  figure.title = "Residuals of the wrist's spheres";
  figure.caption = fmt::format(
      "{} readings of {} about one centre; rms {}. A line of means that stays at zero says that the wrist's axes meet "
      "in one point; one wave over the turn would be a wrong centre, waves that differ by reflector axes that miss.",
      one.campaign.wrist_sweep->rows.size(),
      wrist.table.size() == 1 ? "one reflector" : fmt::format("{} reflectors", wrist.table.size()),
      reports::shownLength(wrist.spheres.rms, 2));
  std::size_t most = 0;
  for (const frames::WristTableRow& of : wrist.table) most = std::max(most, static_cast<std::size_t>(of.readings));
  const std::string drawn = drawnWords(most, kMostReadings, "readings of a reflector");
  if (!drawn.empty()) figure.caption += drawn + " The means are of all.";
  figure.alt = "Points by azimuth and by elevation: radial residuals of the wrist sweep about the common centre.";
  return figure;
}

}  // namespace stiffscope::app
