#include "app/figures/make_figures.h"

#include <fmt/format.h>

#include "app/figures/deflection_scene.h"
#include "app/figures/encoder_bars.h"
#include "app/figures/gap_bars.h"
#include "app/figures/residual_bars.h"
#include "app/figures/residual_directions.h"
#include "app/figures/rigid_sweeps.h"
#include "app/figures/station_drift.h"
#include "app/figures/stiffness_intervals.h"
#include "app/figures/subset_spreads.h"
#include "app/figures/sweep_circles.h"
#include "app/figures/wrist_sphere.h"
#include "render/png.h"
#include "reports/page/avoided_by_encoders.h"
#include "reports/page/html.h"

namespace stiffscope {

namespace {

constexpr Size kChart{1200, 700};
constexpr Size kScene{1200, 800};
constexpr Size kWide{1200, 520};
constexpr std::size_t kMostGhosts = 60;  // more postures in one picture hide each other

template <class Picture>
Figure drawn(Figure figure, const Picture& picture, Size size) {
  const Image image = render(picture, size);
  figure.png = encodePng(image);
  figure.width = image.width;
  figure.height = image.height;
  return figure;
}

/// How good the readings are that everything else stands on.
void addReadings(const ReportCampaign& one, std::vector<Figure>& figures) {
  if (const auto residuals = residualDirections(one))
    figures.push_back(drawn(describeResidualDirections(one, *residuals), *residuals, kChart));
  const RigidPoints points = rigidSweeps(one);
  if (const auto circles = sweepCircles(one, points))
    figures.push_back(drawn(describeSweepCircles(one), *circles, kScene));
  if (const auto sphere = wristSphere(one, points))
    figures.push_back(drawn(describeWristSphere(one), *sphere, kWide));
  const StationMotion station = one.station != nullptr ? *one.station : stationMotionOf(one.campaign);
  if (const auto drift = stationDrift(one, station))
    figures.push_back(drawn(describeStationDrift(station), *drift, kWide));
}

std::vector<Figure> figuresOf(const ReportCampaign& one, const FigureOptions& options) {
  std::vector<Figure> figures;
  if (one.identification.cases.empty()) return figures;
  const ArmScene scene = deflectionScene(one);
  figures.push_back(drawn(describeDeflectionScene(one, automaticMagnification(scene)), scene, kScene));
  if (one.identification.cases.size() <= kMostGhosts) {
    const ArmScene all = allPosturesScene(one);
    figures.push_back(drawn(describeAllPostures(one, automaticMagnification(all)), all, kScene));
  }
  figures.push_back(drawn(describeResidualBars(one), residualBars(one), kChart));
  const GroupedBarChart zoom = residualZoom(one);
  if (zoom.series.size() == 2) figures.push_back(drawn(describeResidualZoom(one), zoom, kChart));
  const SpreadChart spreads = subsetSpreads(one, options.with_paper);
  if (!spreads.panels.empty()) figures.push_back(drawn(describeSubsetSpreads(one), spreads, kChart));
  const IntervalChart intervals = stiffnessIntervals(one);
  if (!intervals.series.empty()) figures.push_back(drawn(describeStiffnessIntervals(one), intervals, kChart));
  if (const auto gap = gapBars(one)) figures.push_back(drawn(describeGapBars(one), *gap, kChart));
  addReadings(one, figures);
  return figures;
}

}  // namespace

std::vector<Figure> makeFigures(const std::vector<ReportCampaign>& campaigns, const FigureOptions& options) {
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < campaigns.size(); ++i) {
    for (Figure& figure : figuresOf(campaigns[i], options)) {
      if (campaigns.size() > 1) {
        figure.id += fmt::format("-{}", i + 1);
        figure.title = fmt::format("{}: {}", page::asIs(campaigns[i].campaign.name), figure.title);
      }
      figures.push_back(std::move(figure));
    }
  }
  if (const auto avoided = avoidedByEncoders(campaigns); avoided && avoided->available) {
    figures.push_back(drawn(describeEncoderBars(*avoided), encoderBars(*avoided), kChart));
  }
  return figures;
}

}  // namespace stiffscope
