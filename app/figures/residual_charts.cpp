#include "app/figures/figures.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "app/figures/chart_series.h"
#include "app/figures/chart_style.h"
#include "core/identification/noise_share.h"
#include "core/preparation/subsample.h"
#include "reports/page/html.h"
#include "reports/report_content.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"

namespace stiffscope::app {

namespace {

constexpr render::Colour kActive{70, 78, 96};  // slate: no method's colour

}  // namespace

render::GroupedBarChart encoderBars(const reports::AvoidedByEncoders& avoided) {
  render::GroupedBarChart chart;
  chart.title = fmt::format("Displacement of {} without and with double encoders", reports::pointOf(avoided));
  chart.subtitle = fmt::format("{} of it avoided over {} postures; no compensation", reports::shareWords(avoided),
                               avoided.postures.size());
  chart.y_title = fmt::format("Displacement of {} (mm)", reports::pointOf(avoided));
  chart.category_title = "Posture";
  chart.series = {{"double encoders inactive", render::colours::kNone, {}, {}},
                  {"double encoders active", kActive, {}, {}}};
  for (const comparison::PostureDeflection& posture : avoided.postures) {
    chart.categories.push_back(reports::asIs(posture.pose));
    chart.series[0].values.push_back(reports::kMmPerM * posture.before);
    chart.series[1].values.push_back(reports::kMmPerM * posture.after);
  }
  return chart;
}

reports::Figure describeEncoderBars(const reports::AvoidedByEncoders& avoided) {
  const auto [least, most] =
      std::minmax_element(avoided.postures.begin(), avoided.postures.end(),
                          [](const comparison::PostureDeflection& a, const comparison::PostureDeflection& b) {
                            return a.share() < b.share();
                          });
  reports::Figure figure;
  figure.id = "double-encoders";
  figure.title = fmt::format("Displacement of {} without and with double encoders", reports::pointOf(avoided));
  figure.caption = fmt::format(
      "Active double encoders avoid {} of the deflection in all; least in posture {} ({}), most in "
      "posture {} ({}).",
      reports::shareWords(avoided), reports::asIs(least->pose), reports::percent(least->share(), 0),
      reports::asIs(most->pose), reports::percent(most->share(), 0));
  figure.alt =
      fmt::format("Bars by posture: length of the displacement of {} with the double encoders inactive and active.",
                  reports::plain(reports::pointOf(avoided)));
  return figure;
}

namespace {

constexpr std::size_t kMostPostures = 200;  // four bars each are hardly a pixel wide

std::vector<double> drawnInMm(const std::vector<double>& values) {
  std::vector<double> drawn;
  for (const std::size_t i : preparation::evenlySpreadIndices(values.size(), kMostPostures))
    drawn.push_back(reports::kMmPerM * values[i]);
  return drawn;
}

/// How the bars were judged: "each posture by 10 of the others".
std::string judgedWords(const reports::ReportCampaign& one) {
  for (const identification::Method method : identification::kMethods) {
    const identification::SubsetStudy& study = one.identification.of(method).subsets;
    if (study.compliances.empty()) continue;
    return fmt::format("each posture by stiffnesses from {} of the others, mean over {} subsets", study.size,
                       study.every_subset ? "all" : "the drawn");
  }
  return fmt::format("identified from and judged on all {} postures", one.identification.cases.size());
}

render::GroupedBarChart emptyChart(const reports::ReportCampaign& one, const char* what, const char* axis) {
  const reports::JudgedPoint point = reports::judgedPoint(one);
  render::GroupedBarChart chart;
  chart.title = fmt::format("{} of {}", what, point.name);
  chart.subtitle = fmt::format("{}; {}", reports::asIs(one.campaign.name), judgedWords(one));
  chart.y_title = fmt::format("{} of {} (mm)", axis, point.name);
  chart.category_title = "Posture";
  for (const std::size_t i : preparation::evenlySpreadIndices(one.identification.cases.size(), kMostPostures)) {
    chart.categories.push_back(reports::postureName(one, i));
  }
  return chart;
}

void addMethod(const reports::ReportCampaign& one, identification::Method method, render::GroupedBarChart& chart) {
  const identification::MethodResult& result = one.identification.of(method);
  const bool at_wrist = reports::judgedPoint(one).at_wrist;
  if (!result.available || reports::residualAt(result, at_wrist).empty()) return;
  const std::vector<double> left = reports::heldOutResidualAt(one, method, at_wrist);
  chart.series.push_back({fmt::format("after {}", reports::longName(method)), colourOf(method), drawnInMm(left), {}});
}

/// Which postures are drawn where not all are, and the longest bar of all.
std::string drawnOf(const reports::ReportCampaign& one, const std::vector<double>& values) {
  const std::string words = drawnWords(values.size(), kMostPostures, "postures");
  if (words.empty()) return {};
  const auto longest = std::max_element(values.begin(), values.end());
  return fmt::format("{} The longest of all is {}\u00a0mm, in posture {}.", words,
                     reports::fixed(reports::kMmPerM * *longest, 2),
                     reports::postureName(one, static_cast<std::size_t>(longest - values.begin())));
}

/// "CP leaves 0.12, PP 0.08 and DPP 0.05 mm in the mean"
std::string leftWords(const reports::ReportCampaign& one, std::initializer_list<identification::Method> methods) {
  const bool at_wrist = reports::judgedPoint(one).at_wrist;
  std::vector<std::string> parts;
  for (const identification::Method method : methods) {
    const identification::MethodResult& result = one.identification.of(method);
    if (!result.available) continue;
    parts.push_back(fmt::format(
        "{} {}", reports::shortName(method),
        reports::significant(reports::kMmPerM * reports::mean(reports::heldOutResidualAt(one, method, at_wrist)), 2)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

render::GroupedBarChart residualBars(const reports::ReportCampaign& one) {
  render::GroupedBarChart chart = emptyChart(one, "Displacement", "Displacement");
  const bool at_wrist = reports::judgedPoint(one).at_wrist;
  chart.series.push_back({"without compensation",
                          render::colours::kNone,
                          drawnInMm(reports::displacementAt(one.identification, at_wrist)),
                          {}});
  for (const identification::Method method : identification::kMethods) addMethod(one, method, chart);
  return chart;
}

render::GroupedBarChart residualZoom(const reports::ReportCampaign& one) {
  render::GroupedBarChart chart = emptyChart(one, "What is left of the displacement", "Left of the displacement");
  for (const identification::Method method :
       {identification::Method::partial_pose, identification::Method::decoupled_partial_pose})
    addMethod(one, method, chart);
  return chart;
}

reports::Figure describeResidualBars(const reports::ReportCampaign& one, bool with_paper) {
  const reports::JudgedPoint point = reports::judgedPoint(one);
  reports::Figure figure;
  figure.id = "compensation-bars";
  figure.title = fmt::format("Displacement of {} before and after compensation", point.name);
  figure.caption = fmt::format(
      "Mean over the postures: {}\u00a0mm without compensation (grey).",
      reports::fixed(reports::kMmPerM * reports::mean(reports::displacementAt(one.identification, point.at_wrist)), 2));
  const std::string left = leftWords(one, {identification::Method::complete_pose, identification::Method::partial_pose,
                                           identification::Method::decoupled_partial_pose});
  if (!left.empty())
    figure.caption +=
        fmt::format(" Left after compensation, by stiffnesses identified without the posture, in mm: {}.", left);
  figure.caption += drawnOf(one, reports::displacementAt(one.identification, point.at_wrist));
  figure.caption += with_paper ? " The counterpart of the paper's Fig. 7."
                               : " Bars: how far it moves in each posture, and what each method leaves of that.";
  figure.alt =
      fmt::format("Bars by posture: length of the displacement of {}, without compensation and after each method.",
                  reports::plain(point.name));
  return figure;
}

reports::Figure describeResidualZoom(const reports::ReportCampaign& one, bool with_paper) {
  const reports::JudgedPoint point = reports::judgedPoint(one);
  reports::Figure figure;
  figure.id = "compensation-zoom";
  figure.title = fmt::format("What PP and DPP leave of the displacement of {}", point.name);
  figure.caption = fmt::format(
      "The same as the figure before, enlarged. Mean over the postures, in mm: {}.",
      leftWords(one, {identification::Method::partial_pose, identification::Method::decoupled_partial_pose}));
  if (with_paper) figure.caption += " The counterpart of the paper's Fig. 8.";
  figure.alt = fmt::format("Bars by posture: what is left of the displacement of {} after PP and DPP.",
                           reports::plain(point.name));
  return figure;
}

namespace {

constexpr double kUmPerM = 1e6;
constexpr double kBand = 2.0;                 // standard deviations: about 95 % of normal noise
constexpr std::size_t kMostDirections = 100;  // a panel is three hundred pixels wide

/// One reflector's residual in one posture, with the directions it is taken apart in.
struct ResidualVector {
  std::size_t load_case = 0;
  int target = 0;
  std::array<double, 3> component{};           ///< m
  std::array<std::optional<double>, 3> sigma;  ///< m
};

bool hasBeam(const reports::ReportCampaign& one, const identification::MethodResult& method) {
  return one.identification.noise && one.campaign.tracker && method.geometry.r0_from_loading;
}

Eigen::Matrix3d directionsAt(const reports::ReportCampaign& one, const identification::MethodResult& method,
                             const identification::TargetMove& move) {
  if (!hasBeam(one, method)) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d station = *method.geometry.r0_from_loading * one.campaign.tracker->station;
  return beamDirections(move.from.allFinite() ? move.from : station, move.unloaded);
}

std::vector<ResidualVector> residualsOf(const reports::ReportCampaign& one,
                                        const identification::MethodResult& method) {
  std::vector<ResidualVector> residuals;
  const auto& cases = one.identification.cases;
  for (std::size_t i = 0; i < cases.size() && i < method.target_rows.size(); ++i) {
    const identification::CaseEquations& rows = method.target_rows[i];
    const Eigen::VectorXd left = rows.right - rows.matrix * method.estimate.compliance;
    for (std::size_t k = 0; k < cases[i].targets.size(); ++k) {
      const identification::TargetMove& move = cases[i].targets[k];
      const auto row = static_cast<Eigen::Index>(3 * k);
      if (row + 3 > left.size()) break;
      const Eigen::Matrix3d directions = directionsAt(one, method, move);
      ResidualVector residual{i, move.target, {}, {}};
      for (int d = 0; d < 3; ++d) {
        const auto at = static_cast<std::size_t>(d);
        residual.component[at] = directions.col(d).dot(left.segment<3>(row));
        if (!hasBeam(one, method)) continue;
        const Eigen::Matrix3d covariance =
            identification::displacementCovariance(*one.campaign.tracker, *method.geometry.r0_from_loading, move);
        residual.sigma[at] = std::sqrt(directions.col(d).dot(covariance * directions.col(d)));
      }
      residuals.push_back(residual);
    }
  }
  return residuals;
}

render::PointPanel panelOf(const reports::ReportCampaign& one, const std::vector<ResidualVector>& residuals,
                           std::size_t d, bool normalised) {
  render::PointPanel panel;
  const auto& cases = one.identification.cases;
  std::vector<std::optional<std::size_t>> place(cases.size());  // in the picture
  for (const std::size_t i : preparation::evenlySpreadIndices(cases.size(), kMostDirections)) {
    place[i] = panel.categories.size();
    panel.categories.push_back(reports::postureName(one, i));
  }
  const std::size_t targets = one.campaign.targets.size();
  for (std::size_t target = 0; target < targets; ++target) {
    render::PointSeries series = seriesLook(target);
    series.name = reports::pointName(one.campaign.targets[target].id);
    for (const ResidualVector& residual : residuals) {
      if (residual.target != static_cast<int>(target) || !place[residual.load_case]) continue;
      const double value = normalised ? residual.component[d] / *residual.sigma[d] : kUmPerM * residual.component[d];
      // Side by side within the posture, so that none hides another.
      const double aside = 0.6 * ((static_cast<double>(target) + 0.5) / static_cast<double>(targets) - 0.5);
      series.points.push_back({static_cast<double>(*place[residual.load_case]) + aside, value});
    }
    panel.series.push_back(std::move(series));
  }
  if (normalised) panel.band = kBand, panel.band_name = "95 % of the tracker's noise alone";
  return panel;
}

}  // namespace

std::optional<render::PointChart> residualDirections(const reports::ReportCampaign& one) {
  const auto shown = reports::shownMethod(one.identification);
  if (!shown) return std::nullopt;
  const identification::MethodResult& method = one.identification.of(*shown);
  const std::vector<ResidualVector> residuals = residualsOf(one, method);
  if (residuals.empty()) return std::nullopt;
  const bool beam = hasBeam(one, method);
  render::PointChart chart;
  chart.title = fmt::format("What {} leaves at the reflectors, by posture and direction", reports::longName(*shown));
  chart.subtitle = reports::asIs(one.campaign.name);
  chart.columns = 3;
  constexpr std::array<const char*, 3> kBeam{"Along the beam", "Across it, level", "Across it, upright"};
  constexpr std::array<const char*, 3> kAxes{"Along x of R_{0}", "Along y of R_{0}", "Along z of R_{0}"};
  for (const bool normalised : {false, true}) {
    if (normalised && !beam) break;
    for (std::size_t d = 0; d < 3; ++d) {
      render::PointPanel panel = panelOf(one, residuals, d, normalised);
      if (!normalised) panel.title = (beam ? kBeam : kAxes)[d];
      if (d == 0) panel.y_title = normalised ? "Residual / noise sd" : "Residual (µm)";
      if (normalised || !beam) panel.x_title = "Posture";
      chart.diagrams.push_back(std::move(panel));
    }
  }
  return chart;
}

namespace {

/// Which postures are drawn where not all are, and the longest residual of all.
std::string drawnDirections(const reports::ReportCampaign& one, const std::vector<ResidualVector>& residuals) {
  const std::string words = drawnWords(one.identification.cases.size(), kMostDirections, "postures");
  if (words.empty()) return {};
  const auto length = [](const ResidualVector& at) {
    return std::hypot(at.component[0], at.component[1], at.component[2]);
  };
  const auto longest =
      std::max_element(residuals.begin(), residuals.end(),
                       [&](const ResidualVector& a, const ResidualVector& b) { return length(a) < length(b); });
  return fmt::format("{} The longest residual of all is {}, of {} in posture {}.", words,
                     reports::shownLength(length(*longest), 2),
                     reports::pointName(one.campaign.targets[static_cast<std::size_t>(longest->target)].id),
                     reports::postureName(one, longest->load_case));
}

}  // namespace

reports::Figure describeResidualDirections(const reports::ReportCampaign& one, const render::PointChart& chart) {
  const identification::Method shown = *reports::shownMethod(one.identification);
  const std::vector<ResidualVector> residuals = residualsOf(one, one.identification.of(shown));
  std::vector<std::string> parts;
  for (std::size_t d = 0; d < 3; ++d) {
    double sum = 0.0;
    for (const ResidualVector& residual : residuals) sum += residual.component[d] * residual.component[d];
    const double rms = kUmPerM * std::sqrt(sum / static_cast<double>(residuals.size()));
    std::string name = chart.diagrams[d].title;
    name[0] = static_cast<char>(name[0] - 'A' + 'a');
    parts.push_back(fmt::format("{} {}", name, reports::significant(rms, 2)));
  }
  reports::Figure figure;
  figure.id = "residuals";
  figure.title = fmt::format("What {} leaves, by posture, reflector and direction", reports::shortName(shown));
  figure.caption = fmt::format("rms in µm: {}.", fmt::join(parts, "; "));  // names have commas in them
  if (chart.diagrams.size() > 3) {
    std::size_t outside = 0, all = 0;
    for (const ResidualVector& residual : residuals) {
      for (std::size_t d = 0; d < 3; ++d) {
        ++all;
        outside += std::abs(residual.component[d]) > kBand * *residual.sigma[d] ? 1u : 0u;
      }
    }
    figure.caption += fmt::format(
        " Below, in parts of what the tracker's noise alone would give: {} lie outside the band, 5\u00a0% would by "
        "noise alone.",
        reports::percent(static_cast<double>(outside) / static_cast<double>(all), 0));
  }
  figure.caption += drawnDirections(one, residuals);
  figure.caption += " Reflectors that go together, posture for posture, show something that the model misses.";
  figure.alt = fmt::format("Points by posture, one panel a direction: what {} leaves of each reflector's displacement.",
                           reports::shortName(shown));
  return figure;
}

}  // namespace stiffscope::app
