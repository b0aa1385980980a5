#include "app/figures/figures.h"

#include <fmt/format.h>

#include "app/figures/accuracy_figures.h"
#include "app/figures/arm_scenes.h"
#include "app/figures/drawn.h"
#include "app/view/view_material.h"
#include "render/image.h"
#include "reports/page/html.h"
#include "reports/report_content.h"
#include "reports/words/effect_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/workspace_words.h"

namespace stiffscope::app {

namespace {

// Two stand beside each other on a page of 1140 pixels, the opening one beside the result: there, and on paper, letters
// of 17 pixels in 1200 would be too small.
constexpr render::Size kChart{960, 560, false, 1.4};
constexpr render::Size kScene{960, 640, false, 1.4};
constexpr render::Size kRows{960, 720, false, 1.4};  // of diagrams one above the other
constexpr render::Size kOpening{840, 560, false, 1.4};
constexpr std::size_t kMostGhosts = 60;  // more postures in one picture hide each other

/// The figures of one campaign, each put into the section of the page that it belongs to.
class FigureList {
 public:
  explicit FigureList(const reports::ReportCampaign& one) : one_(one) {}

  template <class Picture>
  void add(const char* section, reports::Figure figure, const Picture& picture, render::Size size = kChart) {
    figure.section = section;
    if (auto finished = drawnOrLeftOut(figure, picture, size)) figures_.push_back(*std::move(finished));
  }

  /// How good the readings are that everything else stands on.
  void addReadings() {
    if (const auto residuals = residualDirections(one_))
      add("stiffness", describeResidualDirections(one_, *residuals), *residuals, kScene);
    const frames::RigidPoints points = rigidSweeps(one_);
    if (const auto circles = sweepCircles(one_, points)) add("links", describeSweepCircles(one_), *circles, kScene);
    if (const auto sphere = wristSphere(one_, points)) add("wrist", describeWristSphere(one_), *sphere);
    const preparation::StationMotion station = one_.station != nullptr ? *one_.station : stationMotionOf(one_.campaign);
    const char* place = one_.accuracy != nullptr ? "station" : one_.audit != nullptr ? "audit" : "figures";
    if (const auto drift = stationDrift(one_, station)) add(place, describeStationDrift(station), *drift);
  }

  void addDeflection(const DeflectionScene& opening, const FigureOptions& options) {
    add("opening", describeDeflectionScene(one_, opening), opening.scene, kOpening);
    if (one_.identification.cases.size() <= kMostGhosts) {
      const render::ArmScene all = allPosturesScene(one_);
      add("compensation", describeAllPostures(one_, render::automaticMagnification(all)), all, kScene);
    }
    add("compensation", describeResidualBars(one_, options.with_paper), residualBars(one_));
    const render::GroupedBarChart zoom = residualZoom(one_);
    if (zoom.series.size() == 2) add("compensation", describeResidualZoom(one_, options.with_paper), zoom);
  }

  void addStiffness(const FigureOptions& options) {
    const render::SpreadChart spreads = subsetSpreads(one_, options.with_paper);
    if (!spreads.panels.empty()) add("subsets", describeSubsetSpreads(one_), spreads);
    const render::IntervalChart intervals = stiffnessIntervals(one_);
    if (reports::anyPositiveStiffness(one_.identification))
      add("stiffness", describeStiffnessIntervals(one_), intervals);
  }

  void addWorkspace() {
    if (reports::givesInSlice(one_.workspace->slice))
      add("workspace", describeStiffnessSlice(one_), stiffnessSliceChart(one_), kScene);
    const render::IntervalChart by_posture = postureStiffnessChart(one_);
    if (!by_posture.series.empty()) add("workspace", describePostureStiffness(one_), by_posture);
  }

  /// Of a day without a load: before and after, over the workspace and over the day.
  void addAccuracy() {
    if (!one_.accuracy->calibration.reason.empty()) return;
    add("accuracy", describeAccuracyCurves(one_), accuracyCurves(one_));
    add("accuracy", describeAccuracyMap(one_), accuracyMap(one_), kScene);
    if (const auto scenes = accuracyScenes(one_)) {
      add("opening", describeAccuracyBefore(one_, *scenes), scenes->before, kOpening);
      if (!one_.accuracy->calibration.best().fit.parts.empty())
        add("accuracy-gap", describeAccuracyAfter(one_, *scenes), scenes->after, kScene);
    }
    if (const auto classes = effectClasses(one_)) add("accuracy-gap", describeEffectClasses(one_), *classes);
    add("station", describeResidualsOverDay(one_), residualsOverDay(one_), kRows);
  }

  /// What the model misses: beside the diagnosis' words.
  void addGap() {
    if (const auto scenes = gapScenes(one_)) {
      add("gap", describeGapBefore(one_, *scenes), scenes->before, kScene);
      const bool modelled = !reports::namedWords(one_.diagnosis->verdict).empty();
      if (modelled) add("gap", describeGapAfter(one_, *scenes), scenes->after, kScene);
    }
    if (const auto gap = gapBars(one_)) add("gap", describeGapBars(one_), *gap);
    if (const auto classes = effectClasses(one_)) add("gap", describeEffectClasses(one_), *classes);
  }

  /// The arm with the readings of its sweeps; nothing where these do not place R0.
  void addSweeps() {
    const ViewMaterial sweeps = sweepMaterial(one_.campaign, one_.identification.frames);
    if (sweeps.frames.empty()) return;
    render::ArmScene scene = sweeps.frames.front().scene;
    scene.title = "Circle sweeps";
    scene.subtitle = reports::asIs(one_.campaign.name);
    for (render::SceneTrace& trace : scene.traces) trace.faint = false, trace.label.clear();
    scene.trace_name = "tracker readings of all sweeps";
    reports::Figure figure;
    figure.id = "sweeps";
    figure.title = "Circle sweeps";
    figure.caption = fmt::format("The arm in the middle of the sweep of axis {}, and the readings of all sweeps.",
                                 sweeps.frames.front().posture + 1);
    figure.alt = "The arm with the tracker's readings of every axis' sweep as dots around it.";
    add("opening", figure, scene, kOpening);
  }

  std::vector<reports::Figure> take() { return std::move(figures_); }

 private:
  const reports::ReportCampaign& one_;
  std::vector<reports::Figure> figures_;
};

std::vector<reports::Figure> figuresOf(const reports::ReportCampaign& one, const FigureOptions& options,
                                       const std::optional<DeflectionScene>& opening) {
  FigureList list(one);
  const bool loaded = !one.identification.cases.empty();
  if (opening) list.addDeflection(*opening, options);
  if (loaded) list.addStiffness(options);
  if (one.workspace != nullptr) list.addWorkspace();
  if (one.accuracy != nullptr) list.addAccuracy();
  list.addReadings();
  if (loaded) list.addGap();
  if (reports::kindOf(one) == reports::DayKind::sweeps) list.addSweeps();
  return list.take();
}

/// What tells a campaign from the others of a report, in the titles of its figures.
std::string labelOf(const campaign::Campaign& campaign) {
  const std::string state = reports::encoderWords(campaign.double_encoder);
  return state.empty() ? reports::asIs(campaign.name) : state;
}

}  // namespace

std::vector<reports::Figure> makeFigures(const std::vector<reports::ReportCampaign>& campaigns,
                                         const FigureOptions& options,
                                         const std::optional<reports::AvoidedByEncoders>& avoided) {
  std::vector<reports::Figure> figures;
  const std::vector<std::optional<DeflectionScene>> opening = deflectionScenes(campaigns);
  for (std::size_t i = 0; i < campaigns.size(); ++i) {
    for (reports::Figure& figure : figuresOf(campaigns[i], options, opening[i])) {
      if (campaigns.size() > 1) {
        figure.id += fmt::format("-{}", i + 1);
        figure.title += fmt::format(" ({})", labelOf(campaigns[i].campaign));
        figure.campaign = i;
      }
      figures.push_back(std::move(figure));
    }
  }
  if (avoided && avoided->available) {
    reports::Figure figure = describeEncoderBars(*avoided);
    figure.section = "compensation";
    if (auto finished = drawnOrLeftOut(figure, encoderBars(*avoided), kChart)) figures.push_back(*std::move(finished));
  }
  return figures;
}

}  // namespace stiffscope::app
