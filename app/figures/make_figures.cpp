#include "app/figures/make_figures.h"

#include <fmt/format.h>

#include "app/figures/deflection_scene.h"
#include "app/figures/effect_classes.h"
#include "app/figures/encoder_bars.h"
#include "app/figures/gap_bars.h"
#include "app/figures/gap_scene.h"
#include "app/figures/residual_bars.h"
#include "app/figures/residual_directions.h"
#include "app/figures/rigid_sweeps.h"
#include "app/figures/station_drift.h"
#include "app/figures/stiffness_intervals.h"
#include "app/figures/subset_spreads.h"
#include "app/figures/sweep_circles.h"
#include "app/figures/wrist_sphere.h"
#include "app/returned_memory.h"
#include "render/png.h"
#include "reports/page/avoided_by_encoders.h"
#include "reports/page/effect_words.h"
#include "reports/page/html.h"
#include "reports/page/names.h"

namespace stiffscope {

namespace {

constexpr Size kChart{1200, 700};
constexpr Size kScene{1200, 800};
constexpr std::size_t kMostGhosts = 60;  // more postures in one picture hide each other

template <class Picture>
Figure drawn(Figure figure, const Picture& picture, Size size) {
  const Image image = render(picture, size);
  figure.png = encodePng(image);
  figure.width = image.width;
  figure.height = image.height;
  return figure;
}

/// The figures of one campaign, each put into the section of the page that it belongs to.
class FigureList {
 public:
  explicit FigureList(const ReportCampaign& one) : one_(one) {}

  template <class Picture>
  void add(const char* section, Figure figure, const Picture& picture, Size size = kChart) {
    figures_.push_back(drawn(std::move(figure), picture, size));
    figures_.back().section = section;
    returnFreeMemory();  // of making the shaders, and of what was drawn
  }

  /// How good the readings are that everything else stands on.
  void addReadings() {
    if (const auto residuals = residualDirections(one_))
      add("stiffness", describeResidualDirections(one_, *residuals), *residuals);
    const RigidPoints points = rigidSweeps(one_);
    if (const auto circles = sweepCircles(one_, points))
      add("links", describeSweepCircles(one_), *circles, kScene);
    if (const auto sphere = wristSphere(one_, points)) add("wrist", describeWristSphere(one_), *sphere);
    const StationMotion station = one_.station != nullptr ? *one_.station : stationMotionOf(one_.campaign);
    if (const auto drift = stationDrift(one_, station))
      add(one_.audit != nullptr ? "audit" : "figures", describeStationDrift(station), *drift);
  }

  void addDeflection() {
    const ArmScene scene = deflectionScene(one_);
    add("compensation", describeDeflectionScene(one_, automaticMagnification(scene)), scene, kScene);
    if (one_.identification.cases.size() <= kMostGhosts) {
      const ArmScene all = allPosturesScene(one_);
      add("compensation", describeAllPostures(one_, automaticMagnification(all)), all, kScene);
    }
    add("compensation", describeResidualBars(one_), residualBars(one_));
    const GroupedBarChart zoom = residualZoom(one_);
    if (zoom.series.size() == 2) add("compensation", describeResidualZoom(one_), zoom);
  }

  void addStiffness(const FigureOptions& options) {
    const SpreadChart spreads = subsetSpreads(one_, options.with_paper);
    if (!spreads.panels.empty()) add("subsets", describeSubsetSpreads(one_), spreads);
    const IntervalChart intervals = stiffnessIntervals(one_);
    if (!intervals.series.empty()) add("stiffness", describeStiffnessIntervals(one_), intervals);
  }

  /// What the model misses: beside the diagnosis' words.
  void addGap() {
    if (const auto scenes = gapScenes(one_)) {
      add("gap", describeGapBefore(one_, *scenes), scenes->before, kScene);
      const bool modelled = !page::namedWords(one_.diagnosis->verdict).empty();
      if (modelled) add("gap", describeGapAfter(one_, *scenes), scenes->after, kScene);
    }
    if (const auto gap = gapBars(one_)) add("gap", describeGapBars(one_), *gap);
    if (const auto classes = effectClasses(one_)) add("gap", describeEffectClasses(one_), *classes);
  }

  std::vector<Figure> take() { return std::move(figures_); }

 private:
  const ReportCampaign& one_;
  std::vector<Figure> figures_;
};

std::vector<Figure> figuresOf(const ReportCampaign& one, const FigureOptions& options) {
  FigureList list(one);
  const bool loaded = !one.identification.cases.empty();
  if (loaded) list.addDeflection();
  if (loaded) list.addStiffness(options);
  list.addReadings();
  if (loaded) list.addGap();
  return list.take();
}

/// What tells a campaign from the others of a report, in the titles of its figures.
std::string labelOf(const Campaign& campaign) {
  const std::string state = page::encoderWords(campaign.double_encoder);
  return state.empty() ? page::asIs(campaign.name) : state;
}

}  // namespace

std::vector<Figure> makeFigures(const std::vector<ReportCampaign>& campaigns, const FigureOptions& options) {
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < campaigns.size(); ++i) {
    for (Figure& figure : figuresOf(campaigns[i], options)) {
      if (campaigns.size() > 1) {
        figure.id += fmt::format("-{}", i + 1);
        figure.title += fmt::format(" ({})", labelOf(campaigns[i].campaign));
      }
      figures.push_back(std::move(figure));
    }
  }
  if (const auto avoided = avoidedByEncoders(campaigns); avoided && avoided->available) {
    figures.push_back(drawn(describeEncoderBars(*avoided), encoderBars(*avoided), kChart));
    figures.back().section = "compensation";
  }
  return figures;
}

}  // namespace stiffscope
