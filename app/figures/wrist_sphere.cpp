#include "app/figures/wrist_sphere.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/figures/drawn_words.h"
#include "app/figures/series_look.h"
#include "core/diagnosis/evenly_spread.h"
#include "core/input/units.h"
#include "reports/page/html.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

constexpr std::size_t kLeastInSector = 5;  // a mean of fewer readings says little
constexpr std::size_t kMostReadings = 1000;  // of a reflector

struct SphereResidual {
  int target = 0;
  double azimuth_deg = 0.0, elevation_deg = 0.0, residual_um = 0.0;
};

std::vector<SphereResidual> residualsOf(const ReportCampaign& one, const RigidPoints& points) {
  std::vector<SphereResidual> residuals;
  const WristCentre& wrist = one.identification.frames.wrist;
  const auto r0_from_points = r0FromTable(one.identification.frames, one.campaign.wrist_sweep->frame);
  if (!r0_from_points) return residuals;
  const auto& rows = one.campaign.wrist_sweep->rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector3d arm = *r0_from_points * points.wrist_sweep[i] - wrist.centre_in_r0;
    const double radius = wrist.radii[static_cast<std::size_t>(rows[i].target)];
    if (!std::isfinite(radius)) continue;
    residuals.push_back({rows[i].target, std::atan2(arm.y(), arm.x()) / kDegree,
                         std::asin(std::clamp(arm.z() / arm.norm(), -1.0, 1.0)) / kDegree,
                         (arm.norm() - radius) / kMicrometre});
  }
  return residuals;
}

/// Means over equal sectors of [lower, upper], joined.
PointSeries sectorMeans(const std::vector<SphereResidual>& residuals, double SphereResidual::* angle, double lower,
                        double upper, std::size_t sectors) {
  std::vector<double> sum(sectors, 0.0);
  std::vector<std::size_t> count(sectors, 0);
  const double width = (upper - lower) / static_cast<double>(sectors);
  for (const SphereResidual& one : residuals) {
    const auto at = std::min(sectors - 1, static_cast<std::size_t>((one.*angle - lower) / width));
    sum[at] += one.residual_um;
    ++count[at];
  }
  PointSeries means;
  means.name = "mean in sectors";
  means.colour = colours::kInk;
  means.mark = PointMark::None;
  means.joined = true;
  for (std::size_t i = 0; i < sectors; ++i) {
    if (count[i] >= kLeastInSector)
      means.points.push_back({lower + (static_cast<double>(i) + 0.5) * width, sum[i] / static_cast<double>(count[i])});
  }
  return means;
}

PointPanel spherePanel(const ReportCampaign& one, const std::vector<SphereResidual>& residuals,
                   double SphereResidual::* angle) {
  PointPanel panel;
  // Of each reflector by itself: where they take turns, every so many readings may be always the same one's.
  std::vector<std::vector<std::size_t>> readings(one.campaign.targets.size());
  for (std::size_t i = 0; i < residuals.size(); ++i) readings[static_cast<std::size_t>(residuals[i].target)].push_back(i);
  for (std::size_t target = 0; target < readings.size(); ++target) {
    PointSeries series = seriesLook(target);
    series.name = page::pointName(one.campaign.targets[target].id);
    for (const std::size_t k : evenlySpreadIndices(readings[target].size(), kMostReadings)) {
      const SphereResidual& at = residuals[readings[target][k]];
      series.points.push_back({at.*angle, at.residual_um});
    }
    if (!series.points.empty()) panel.series.push_back(std::move(series));
  }
  return panel;
}

}  // namespace

std::optional<PointChart> wristSphere(const ReportCampaign& one, const RigidPoints& points) {
  if (!one.campaign.wrist_sweep || !one.identification.frames.wrist.measured) return std::nullopt;
  const std::vector<SphereResidual> residuals = residualsOf(one, points);
  if (residuals.empty()) return std::nullopt;
  PointChart chart;
  chart.title = "Radial residuals of the wrist's spheres";
  chart.subtitle = page::asIs(one.campaign.name);
  chart.columns = 2;
  PointPanel azimuth = spherePanel(one, residuals, &SphereResidual::azimuth_deg);
  azimuth.series.push_back(sectorMeans(residuals, &SphereResidual::azimuth_deg, -180.0, 180.0, 18));
  azimuth.x_title = "Azimuth about P_{wrist} (°)";
  azimuth.y_title = "Radial residual (µm)";
  PointPanel elevation = spherePanel(one, residuals, &SphereResidual::elevation_deg);
  elevation.series.push_back(sectorMeans(residuals, &SphereResidual::elevation_deg, -90.0, 90.0, 9));
  elevation.x_title = "Elevation (°)";
  chart.diagrams = {std::move(azimuth), std::move(elevation)};
  return chart;
}

Figure describeWristSphere(const ReportCampaign& one) {
  const WristCentre& wrist = one.identification.frames.wrist;
  Figure figure;
  figure.id = "wrist-sphere";
  figure.title = "Residuals of the wrist's spheres";
  figure.caption = fmt::format(
      "{} readings of {} about one centre; rms {}\u00a0µm. A line of means that stays at zero says that the wrist's axes "
      "meet in one point; one wave over the turn would be a wrong centre, waves that differ by reflector axes that miss.",
      one.campaign.wrist_sweep->rows.size(),
      wrist.table.size() == 1 ? "one reflector" : fmt::format("{} reflectors", wrist.table.size()),
      page::significant(wrist.spheres.rms / kMicrometre, 2));
  std::size_t most = 0;
  for (const WristTableRow& of : wrist.table) most = std::max(most, static_cast<std::size_t>(of.readings));
  const std::string drawn = drawnWords(most, kMostReadings, "readings of a reflector");
  if (!drawn.empty()) figure.caption += drawn + " The means are of all.";
  figure.alt = "Points by azimuth and by elevation: radial residuals of the wrist sweep about the common centre.";
  return figure;
}

}  // namespace stiffscope
