#include "app/figures/figures.h"

#include <fmt/format.h>
#include <array>
#include <cmath>

#include "app/figures/chart_style.h"
#include "core/frames/joint_axes.h"
#include "core/io/units.h"
#include "reports/page/html.h"
#include "reports/words/numbers.h"

namespace stiffscope::app {

namespace {

constexpr double kSecondsPerHour = 3600.0;
constexpr double kMicroradian = 1e-6;

double largestMotion(const preparation::StationMotion& station) {
  double largest = 0.0;
  for (const preparation::StationEpoch& epoch : station.epochs)
    largest = std::max(largest, epoch.motion.tail<3>().norm());
  return largest;
}

bool inMillimetres(const preparation::StationMotion& station) { return largestMotion(station) > 2e-3; }

/// Three of the six parameters of the motion against time, in `unit`.
render::PointPanel motionPanel(const preparation::StationMotion& station, int first, double unit) {
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  render::PointPanel panel;
  for (int k = 0; k < 3; ++k) {
    render::PointSeries series = seriesLook(static_cast<std::size_t>(k));
    series.name = kAxes[static_cast<std::size_t>(k)];
    series.joined = true;
    for (const preparation::StationEpoch& epoch : station.epochs) {
      // Side by side, so that no whisker hides another.
      const double span_h = (station.epochs.back().time_s - station.epochs.front().time_s) / kSecondsPerHour;
      series.points.push_back(
          {epoch.time_s / kSecondsPerHour + 0.006 * span_h * (k - 1), epoch.motion[first + k] / unit});
      series.errors.push_back(2.0 * std::sqrt(epoch.covariance(first + k, first + k)) / unit);
    }
    panel.series.push_back(std::move(series));
  }
  panel.x_title = "Time (h)";
  return panel;
}

render::PointPanel nestPanel(const campaign::Campaign& campaign, double unit) {
  render::PointPanel panel;
  for (std::size_t nest = 0; nest < campaign.nest_ids.size(); ++nest) {
    render::PointSeries series = seriesLook(nest);
    series.name = "nest " + reports::asIs(campaign.nest_ids[nest]);
    series.joined = true;
    std::optional<Eigen::Vector3d> first;
    for (const campaign::NestReading& reading : campaign.nests->rows) {
      if (reading.nest != static_cast<int>(nest)) continue;
      if (!first) first = reading.point;
      series.points.push_back({reading.time_s / kSecondsPerHour, (reading.point - *first).norm() / unit});
    }
    panel.series.push_back(std::move(series));
  }
  panel.title = "Each nest from its start";
  panel.x_title = "Time (h)";
  panel.y_title = unit == io::kMillimetre ? "Distance (mm)" : "Distance (µm)";
  return panel;
}

}  // namespace

std::optional<render::PointChart> stationDrift(const reports::ReportCampaign& one,
                                               const preparation::StationMotion& station) {
  if (!station.tested) return std::nullopt;
  render::PointChart chart;
  chart.title = "Motion of the station over the day, by the floor nests";
  chart.subtitle =
      fmt::format("{}; whiskers: 2 standard uncertainties by the declared noise", reports::asIs(one.campaign.name));
  chart.columns = 3;
  chart.legend_a_panel = true;  // x, y, z and the nests have the same colours and marks
  const bool far = inMillimetres(station);
  const double unit = far ? io::kMillimetre : io::kMicrometre;
  render::PointPanel displacement = motionPanel(station, 3, unit), rotation = motionPanel(station, 0, kMicroradian);
  displacement.title = "Displacement at the arm";
  displacement.y_title = far ? "Displacement (mm)" : "Displacement (µm)";
  rotation.title = "Rotation";
  rotation.y_title = "Rotation (µrad)";
  chart.diagrams = {std::move(displacement), std::move(rotation), nestPanel(one.campaign, unit)};
  return chart;
}

reports::Figure describeStationDrift(const preparation::StationMotion& station) {
  const double largest = largestMotion(station);
  const std::string words = reports::shownLength(largest, 2);
  reports::Figure figure;
  figure.id = "station-drift";
  figure.title = "Motion of the tracker's station";
  figure.caption =
      fmt::format("At the arm the station moved by at most {} against the first of {} rounds: {}.", words,
                  station.epochs.size(), station.moved ? "more than noise explains" : "no more than noise explains");
  figure.alt =
      "Lines over time: displacement and rotation of the station, and how far each nest was read from its "
      "first reading.";
  return figure;
}

preparation::StationMotion stationMotionOf(const campaign::Campaign& campaign) {
  if (!campaign.tracker) return preparation::stationMotion(campaign, std::nullopt);
  const campaign::Tracker& tracker = *campaign.tracker;
  const bool declared =
      tracker.range_fixed + tracker.range_per_m > 0.0 && tracker.angle_fixed + tracker.angle_per_m > 0.0;
  return preparation::stationMotion(campaign, declared ? std::optional(frames::trackerNoise(tracker)) : std::nullopt);
}

}  // namespace stiffscope::app
