#include "app/figures/accuracy_figures.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/figures/chart_series.h"
#include "app/figures/chart_style.h"
#include "core/io/units.h"
#include "core/numerics/resampling.h"
#include "core/preparation/subsample.h"
#include "render/ticks.h"
#include "reports/page/html.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"

namespace stiffscope::app {

using calibration::CalibratedModel;
using calibration::ReadingError;

namespace {

/// The models that are drawn: the own weight by itself is between the others.
std::vector<CalibratedModel> drawnModels(const calibration::Calibration& calibration) {
  std::vector<CalibratedModel> models{CalibratedModel::nominal, CalibratedModel::geometry};
  if (!calibration.best().fit.parts.empty()) models.push_back(CalibratedModel::effects);
  return models;
}

render::Colour modelColour(CalibratedModel model) {
  if (model == CalibratedModel::nominal) return render::colours::kAxis;
  return render::colours::kSeries[model == CalibratedModel::geometry ? 0 : 1];
}

const char* judgedWords(const calibration::Calibration& calibration) {
  return calibration.geometry().held_out.readings > 0 ? "each posture by what the other folds fit"
                                                      : "postures that took part in the fit";
}

render::PointSeries curveOf(const std::vector<ReadingError>& errors, CalibratedModel model) {
  const std::vector<double> lengths = calibration::errorLengths(errors, model);
  render::PointSeries curve;
  curve.name = reports::modelWords(model);
  curve.colour = modelColour(model);
  curve.mark = render::PointMark::none;
  curve.joined = true;
  curve.points.push_back({0.0, 0.0});
  constexpr std::size_t kMostCorners = 400;
  for (const std::size_t i : preparation::evenlySpreadIndices(lengths.size(), kMostCorners)) {
    const double share = static_cast<double>(i + 1) / static_cast<double>(lengths.size());
    curve.points.push_back({lengths[i] / io::kMillimetre, 100.0 * share});
  }
  for (const render::PlotPoint& corner : curve.points) curve.values.push_back({corner.y, corner.x});
  return curve;
}

/// Of the `models` drawn the calibrated ones whose largest errors are half of the largest of all at most: what a second
/// panel shows larger.
std::vector<CalibratedModel> enlargedModels(const std::vector<ReadingError>& errors,
                                            const std::vector<CalibratedModel>& models) {
  const auto largest = [&errors](CalibratedModel model) { return calibration::errorLengths(errors, model).back(); };
  double most = 0.0;
  for (const CalibratedModel model : models) most = std::max(most, largest(model));
  std::vector<CalibratedModel> enlarged;
  for (const CalibratedModel model : models) {
    if (model != CalibratedModel::nominal && largest(model) <= 0.5 * most) enlarged.push_back(model);
  }
  return enlarged;
}

}  // namespace

render::PointChart accuracyCurves(const reports::ReportCampaign& one) {
  const calibration::Calibration& calibration = one.accuracy->calibration;
  const std::vector<ReadingError> errors = calibration::readingErrors(calibration);
  render::PointChart chart;
  chart.title = "Position error before and after, share of readings below";
  chart.subtitle = fmt::format("{}; {}", reports::asIs(one.campaign.name), judgedWords(calibration));
  render::PointPanel all, near;
  all.title = "All models";
  all.y_title = "Share of readings (%)";
  const std::vector<CalibratedModel> models = drawnModels(calibration);
  for (const CalibratedModel model : models) all.series.push_back(curveOf(errors, model));
  const std::vector<CalibratedModel> enlarged = enlargedModels(errors, models);
  for (const CalibratedModel model : enlarged) near.series.push_back(curveOf(errors, model));
  if (enlarged.size() + 1 == models.size())
    near.title = "Without the nominal one, enlarged";
  else if (!enlarged.empty())
    near.title = fmt::format("{}, enlarged", reports::capitalised(reports::shortModelWords(enlarged.back())));
  chart.diagrams.push_back(std::move(all));
  if (!enlarged.empty()) chart.diagrams.push_back(std::move(near));
  for (render::PointPanel& panel : chart.diagrams) panel.x_title = "Position error, 3-D (mm)";
  chart.columns = static_cast<int>(chart.diagrams.size());
  return chart;
}

reports::Figure describeAccuracyCurves(const reports::ReportCampaign& one) {
  const calibration::Calibration& calibration = one.accuracy->calibration;
  const std::vector<ReadingError> errors = calibration::readingErrors(calibration);
  std::vector<std::string> parts;
  for (const CalibratedModel model : drawnModels(calibration)) {
    constexpr double kMost = 0.95;
    const std::vector<double> lengths = calibration::errorLengths(errors, model);
    parts.push_back(
        fmt::format("{} {}", reports::modelWords(model), reports::millimetres(numerics::quantile(lengths, kMost))));
  }
  reports::Figure figure;
  figure.id = "accuracy-curves";
  figure.title = "Position error before and after";
  figure.caption = fmt::format(
      "How many readings lie below an error. 95\u00a0% of them do at: {}. A curve with a long flat end has a few bad "
      "postures; one that is shifted as a whole a bad model.",
      fmt::join(parts, ", "));
  figure.alt = "Curves, one a model: share of the readings whose 3-D position error is below the value on the axis.";
  return figure;
}

namespace {

constexpr std::size_t kMostPlaces = 1200;  // more in one map hide each other

/// From small to large: lightness falls, so that a grey print and colour-blind eyes see it, too. Hues go all the way
/// round, so that they stay apart where the page in the dark turns lightness over, too (a test).
constexpr std::array<render::Colour, 8> kByError{{{255, 193, 82},
                                                  {70, 214, 29},
                                                  {4, 184, 123},
                                                  {7, 163, 145},
                                                  {14, 140, 164},
                                                  {81, 100, 170},
                                                  {157, 9, 148},
                                                  {61, 18, 70}}};

/// Limits between the colours, m, ascending: of the series 1-2-5, from the better half by the best model to the largest
/// by the nominal one.
std::vector<double> colourLimits(const std::vector<ReadingError>& errors, CalibratedModel best) {
  const std::vector<double> least = calibration::errorLengths(errors, best);
  const std::vector<double> most = calibration::errorLengths(errors, CalibratedModel::nominal);
  constexpr double kSmallest = 1e-6, kBeyond = 1.01;
  double limit = render::roundUp125(std::max(kSmallest, numerics::quantile(least, 0.5)));
  std::vector<double> limits;
  for (; limit < most.back() || limits.empty(); limit = render::roundUp125(kBeyond * limit)) limits.push_back(limit);
  // Too many: every second or third, the largest kept.
  const std::size_t every = (limits.size() + kByError.size() - 2) / (kByError.size() - 1);
  std::vector<double> kept;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    if ((limits.size() - 1 - i) % every == 0) kept.push_back(limits[i]);
  }
  return kept;
}

std::string classWords(const std::vector<double>& limits, std::size_t at) {
  const auto mm = [](double metres) { return render::shortNumber(metres / io::kMillimetre); };
  if (at == 0) return fmt::format("below {} mm", mm(limits.front()));
  if (at == limits.size()) return fmt::format("above {} mm", mm(limits.back()));
  return fmt::format("{} to {} mm", mm(limits[at - 1]), mm(limits[at]));
}

/// A projection of base_link: two of its axes.
struct Projection {
  int right, up;
  const char* words;  ///< short: three panels stand side by side
};
constexpr std::array<Projection, 2> kProjections{{{0, 1, "above"}, {0, 2, "side"}}};

/// The middle of all places and of the base, and how far they reach from it, in a projection.
struct Extent {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double reach = 0.0;
};

Extent extentOf(const std::vector<ReadingError>& errors, const Projection& projection) {
  Eigen::AlignedBox2d box(Eigen::Vector2d(0.0, 0.0));
  for (const ReadingError& error : errors)
    box.extend(Eigen::Vector2d(error.position[projection.right], error.position[projection.up]));
  return {box.center(), 0.5 * box.sizes().maxCoeff()};
}

render::ShapePanel mapPanel(const calibration::UnloadedDay& day, const std::vector<ReadingError>& errors,
                            CalibratedModel model, const std::vector<double>& limits, const Projection& projection,
                            double reach) {
  const Extent extent = extentOf(errors, projection);
  render::ShapePanel panel;
  panel.title = fmt::format("{}, {}", reports::capitalised(reports::shortModelWords(model)), projection.words);
  render::PointSeries frame;  // all panels to one scale
  frame.mark = render::PointMark::none;
  frame.points = {{reach, reach}};
  panel.series.push_back(std::move(frame));
  for (std::size_t c = 0; c <= limits.size(); ++c) {
    render::PointSeries series;
    series.name = classWords(limits, c);
    series.colour = kByError[(2 * c * (kByError.size() - 1) + limits.size()) / (2 * limits.size())];
    panel.series.push_back(std::move(series));
  }
  for (const std::size_t i : preparation::evenlySpreadIndices(errors.size(), kMostPlaces)) {
    const ReadingError& error = errors[i];
    const auto at = static_cast<std::size_t>(std::upper_bound(limits.begin(), limits.end(), error.of(model).norm()) -
                                             limits.begin());
    panel.series[1 + at].points.push_back(
        {error.position[projection.right] - extent.middle.x(), error.position[projection.up] - extent.middle.y()});
    const auto pose = static_cast<std::size_t>(day.postures[error.posture].pose);
    panel.series[1 + at].values.push_back(
        {error.of(model).norm() / io::kMillimetre, 0.0, reports::asIs(day.pose_ids[pose])});
  }
  panel.value_name = "Position error, 3-D (mm)";
  render::PointSeries base;
  base.name = "base_link";
  base.colour = render::colours::kSeries[1];  // ink and the largest errors are one white in the dark
  base.mark = render::PointMark::square;
  base.points = {{-extent.middle.x(), -extent.middle.y()}};
  panel.series.push_back(std::move(base));
  panel.scale_bar = render::roundDown125(0.7 * reach);
  panel.scale_name = fmt::format("{} m", render::shortNumber(panel.scale_bar));
  return panel;
}

}  // namespace

render::PointChart accuracyMap(const reports::ReportCampaign& one) {
  const calibration::Calibration& calibration = one.accuracy->calibration;
  const std::vector<ReadingError> errors = calibration::readingErrors(calibration);
  const std::vector<CalibratedModel> models = drawnModels(calibration);
  const std::vector<double> limits = colourLimits(errors, models.back());
  double reach = 0.0;
  for (const Projection& projection : kProjections) reach = std::max(reach, extentOf(errors, projection).reach);
  render::PointChart chart;
  chart.title = "Position error over the workspace, before and after";
  chart.subtitle = fmt::format("{}; {}", reports::asIs(one.campaign.name), judgedWords(calibration));
  chart.note = "Places of the reflectors in base_link, from above (x to the right, y up) and from the side (x, z).";
  chart.note += drawnWords(errors.size(), kMostPlaces, "readings");
  chart.columns = static_cast<int>(models.size());
  for (const Projection& projection : kProjections) {
    for (const CalibratedModel model : models)
      chart.shapes.push_back(mapPanel(calibration.day, errors, model, limits, projection, reach));
  }
  return chart;
}

reports::Figure describeAccuracyMap(const reports::ReportCampaign& one) {
  const calibration::Calibration& calibration = one.accuracy->calibration;
  const std::vector<ReadingError> errors = calibration::readingErrors(calibration);
  const CalibratedModel best = drawnModels(calibration).back();
  const ReadingError worst = calibration::worstPostures(errors, best, 1).front();
  const int pose = calibration.day.postures[worst.posture].pose;
  reports::Figure figure;
  figure.id = "accuracy-map";
  figure.title = "Position error over the workspace";
  figure.caption = fmt::format(
      "Every reflector where it stood, coloured by the error; one scale for all models. The largest that is left is "
      "{}, of {} in posture {}. Errors that stay together in one region are the machine's; noise is spread evenly.",
      reports::millimetres(worst.of(best).norm()),
      reports::pointName(calibration.day.targets[static_cast<std::size_t>(worst.target)]),
      reports::asIs(calibration.day.pose_ids[static_cast<std::size_t>(pose)]));
  figure.category_name = "Posture";
  figure.alt = "Maps from above and from the side, one a model: places of the reflectors, coloured by position error.";
  return figure;
}

namespace {

constexpr double kHour = 3600.0;
constexpr std::size_t kMostOverDay = 600;
constexpr std::size_t kMeans = 12;

/// Hours, or the number of the posture where no times are known.
double placeInDay(const calibration::UnloadedDay& day, std::size_t posture) {
  if (!day.times_known) return static_cast<double>(posture + 1);
  return (day.first_time_s + day.postures[posture].time * day.time_span_s) / kHour;
}

render::PointPanel dayPanel(const calibration::Calibration& calibration, const std::vector<ReadingError>& errors,
                            const std::vector<CalibratedModel>& models, bool beam, int direction) {
  render::PointPanel panel;
  for (const CalibratedModel model : models) {
    std::vector<render::PlotPoint> points;
    for (const ReadingError& error : errors) {
      const Eigen::Matrix3d axes = beam ? beamDirections(error.station, error.position) : Eigen::Matrix3d::Identity();
      points.push_back(
          {placeInDay(calibration.day, error.posture), axes.col(direction).dot(error.of(model)) / io::kMicrometre});
    }
    render::PointSeries series;
    series.name = reports::modelWords(model);
    series.colour = modelColour(model);
    for (const std::size_t i : preparation::evenlySpreadIndices(points.size(), kMostOverDay))
      series.points.push_back(points[i]);
    const double last = points.empty() ? 1.0 : points.back().x, first = points.empty() ? 0.0 : points.front().x;
    render::PointSeries means = meansOver(points, first, last, kMeans);
    means.name = fmt::format("mean, {}", reports::modelWords(model));
    means.colour = model == CalibratedModel::geometry ? render::colours::kSeries[2] : render::colours::kInk;
    panel.series.push_back(std::move(series));
    panel.series.push_back(std::move(means));
  }
  // Lines last, over the points.
  std::stable_partition(panel.series.begin(), panel.series.end(),
                        [](const render::PointSeries& series) { return !series.joined; });
  return panel;
}

}  // namespace

render::PointChart residualsOverDay(const reports::ReportCampaign& one) {
  const calibration::Calibration& calibration = one.accuracy->calibration;
  const std::vector<ReadingError> errors = calibration::readingErrors(calibration);
  const bool beam = one.campaign.tracker.has_value();
  render::PointChart chart;
  chart.title = "Left over the day, by direction";
  chart.subtitle = fmt::format("{}; {}", reports::asIs(one.campaign.name), judgedWords(calibration));
  chart.note = drawnWords(errors.size(), kMostOverDay, "readings");
  if (!chart.note.empty()) chart.note = chart.note.substr(1) + " The means are of all.";
  std::vector<CalibratedModel> models = drawnModels(calibration);
  std::erase(models, CalibratedModel::nominal);
  // What effects leave would be a flat line beside what the geometry leaves: then it has panels of its own.
  const std::vector<CalibratedModel> enlarged = enlargedModels(errors, models);
  chart.columns = enlarged.empty() ? 1 : 2;
  constexpr std::array<const char*, 3> kBeam{"Along the beam", "Across it, level", "Across it, upright"};
  constexpr std::array<const char*, 3> kAxes{"Along x of base_link", "Along y of base_link", "Along z of base_link"};
  for (int d = 0; d < 3; ++d) {
    const auto add = [&](const std::vector<CalibratedModel>& of, const std::string& which) {
      render::PointPanel panel = dayPanel(calibration, errors, of, beam, d);
      panel.title = (beam ? kBeam : kAxes)[static_cast<std::size_t>(d)] + which;
      panel.y_title = "Left (µm)";
      if (d == 2) panel.x_title = calibration.day.times_known ? "Time (h)" : "Posture, in the order of the day";
      chart.diagrams.push_back(std::move(panel));
    };
    add(models, "");
    if (!enlarged.empty()) add(enlarged, fmt::format(", {}", reports::shortModelWords(enlarged.back())));
  }
  return chart;
}

reports::Figure describeResidualsOverDay(const reports::ReportCampaign& one) {
  const calibration::Calibration& calibration = one.accuracy->calibration;
  reports::Figure figure;
  figure.id = "over-the-day";
  figure.title = "What the models leave over the day";
  figure.caption = fmt::format(
      "Measured less modelled at each reflector{}. Means that wander are a station that drifts, an arm that warms up "
      "or something that moved at a time; points that scatter alike all day are of the postures themselves.",
      calibration.day.times_known ? "" : ", in the order of the postures: no times are stated");
  figure.alt = "Points over time, one panel a direction: what the calibrated geometry leaves, and what effects leave.";
  return figure;
}

}  // namespace stiffscope::app
