#include "app/figures/residual_directions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/figures/drawn_words.h"
#include "app/figures/series_look.h"
#include "core/diagnosis/evenly_spread.h"
#include "core/identification/noise_share.h"
#include "reports/page/html.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

constexpr double kUmPerM = 1e6;
constexpr double kBand = 2.0;  // standard deviations: about 95 % of normal noise
constexpr std::size_t kMostDirections = 100;  // a panel is three hundred pixels wide

/// One reflector's residual in one posture, with the directions it is taken apart in.
struct ResidualVector {
  std::size_t load_case = 0;
  int target = 0;
  std::array<double, 3> component{};           ///< m
  std::array<std::optional<double>, 3> sigma;  ///< m
};

bool hasBeam(const ReportCampaign& one, const MethodResult& method) {
  return one.identification.noise && one.campaign.tracker && method.geometry.r0_from_loading;
}

Eigen::Matrix3d directionsAt(const ReportCampaign& one, const MethodResult& method,
                             const Eigen::Vector3d& point) {
  if (!hasBeam(one, method)) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d station = *method.geometry.r0_from_loading * one.campaign.tracker->station;
  const Eigen::Vector3d beam = (point - station).normalized();
  Eigen::Vector3d level = Eigen::Vector3d::UnitZ().cross(beam);
  level = level.norm() > 1e-9 ? level.normalized() : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  Eigen::Matrix3d directions;
  directions << beam, level, beam.cross(level);
  return directions;
}

std::vector<ResidualVector> residualsOf(const ReportCampaign& one, const MethodResult& method) {
  std::vector<ResidualVector> residuals;
  const auto& cases = one.identification.cases;
  for (std::size_t i = 0; i < cases.size() && i < method.target_rows.size(); ++i) {
    const CaseEquations& rows = method.target_rows[i];
    const Eigen::VectorXd left = rows.right - rows.matrix * method.estimate.compliance;
    for (std::size_t k = 0; k < cases[i].targets.size(); ++k) {
      const TargetMove& move = cases[i].targets[k];
      const auto row = static_cast<Eigen::Index>(3 * k);
      if (row + 3 > left.size()) break;
      const Eigen::Matrix3d directions = directionsAt(one, method, move.unloaded);
      ResidualVector residual{i, move.target, {}, {}};
      for (int d = 0; d < 3; ++d) {
        const auto at = static_cast<std::size_t>(d);
        residual.component[at] = directions.col(d).dot(left.segment<3>(row));
        if (!hasBeam(one, method)) continue;
        const Eigen::Matrix3d covariance =
            displacementCovariance(*one.campaign.tracker, *method.geometry.r0_from_loading, move);
        residual.sigma[at] = std::sqrt(directions.col(d).dot(covariance * directions.col(d)));
      }
      residuals.push_back(residual);
    }
  }
  return residuals;
}

PointPanel panelOf(const ReportCampaign& one, const std::vector<ResidualVector>& residuals, std::size_t d,
                   bool normalised) {
  PointPanel panel;
  const auto& cases = one.identification.cases;
  std::vector<std::optional<std::size_t>> place(cases.size());  // in the picture
  for (const std::size_t i : evenlySpreadIndices(cases.size(), kMostDirections)) {
    place[i] = panel.categories.size();
    panel.categories.push_back(page::postureName(one, i));
  }
  const std::size_t targets = one.campaign.targets.size();
  for (std::size_t target = 0; target < targets; ++target) {
    PointSeries series = seriesLook(target);
    series.name = page::pointName(one.campaign.targets[target].id);
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

std::optional<PointChart> residualDirections(const ReportCampaign& one) {
  const auto shown = page::shownMethod(one.identification);
  if (!shown) return std::nullopt;
  const MethodResult& method = one.identification.of(*shown);
  const std::vector<ResidualVector> residuals = residualsOf(one, method);
  if (residuals.empty()) return std::nullopt;
  const bool beam = hasBeam(one, method);
  PointChart chart;
  chart.title = fmt::format("What {} leaves at the reflectors, by posture and direction", page::longName(*shown));
  chart.subtitle = page::asIs(one.campaign.name);
  chart.columns = 3;
  constexpr std::array<const char*, 3> kBeam{"Along the beam", "Across it, level", "Across it, upright"};
  constexpr std::array<const char*, 3> kAxes{"Along x of R_{0}", "Along y of R_{0}", "Along z of R_{0}"};
  for (const bool normalised : {false, true}) {
    if (normalised && !beam) break;
    for (std::size_t d = 0; d < 3; ++d) {
      PointPanel panel = panelOf(one, residuals, d, normalised);
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
std::string drawnDirections(const ReportCampaign& one, const std::vector<ResidualVector>& residuals) {
  const std::string words = drawnWords(one.identification.cases.size(), kMostDirections, "postures");
  if (words.empty()) return {};
  const auto length = [](const ResidualVector& at) { return std::hypot(at.component[0], at.component[1], at.component[2]); };
  const auto longest =
      std::max_element(residuals.begin(), residuals.end(),
                       [&](const ResidualVector& a, const ResidualVector& b) { return length(a) < length(b); });
  return fmt::format("{} The longest residual of all is {}\u00a0µm, of {} in posture {}.", words,
                     page::significant(kUmPerM * length(*longest), 2),
                     page::pointName(one.campaign.targets[static_cast<std::size_t>(longest->target)].id),
                     page::postureName(one, longest->load_case));
}

}  // namespace

Figure describeResidualDirections(const ReportCampaign& one, const PointChart& chart) {
  const Method shown = *page::shownMethod(one.identification);
  const std::vector<ResidualVector> residuals = residualsOf(one, one.identification.of(shown));
  std::vector<std::string> parts;
  for (std::size_t d = 0; d < 3; ++d) {
    double sum = 0.0;
    for (const ResidualVector& residual : residuals) sum += residual.component[d] * residual.component[d];
    const double rms = kUmPerM * std::sqrt(sum / static_cast<double>(residuals.size()));
    std::string name = chart.diagrams[d].title;
    name[0] = static_cast<char>(name[0] - 'A' + 'a');
    parts.push_back(fmt::format("{} {}", name, page::significant(rms, 2)));
  }
  Figure figure;
  figure.id = "residuals";
  figure.title = fmt::format("What {} leaves, by posture, reflector and direction", page::shortName(shown));
  figure.caption = fmt::format("rms in µm: {}.", fmt::join(parts, ", "));
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
        page::percent(static_cast<double>(outside) / static_cast<double>(all), 0));
  }
  figure.caption += drawnDirections(one, residuals);
  figure.caption += " Reflectors that go together, posture for posture, show something that the model misses.";
  figure.alt = fmt::format("Points by posture, one panel a direction: what {} leaves of each reflector's displacement.",
                           page::shortName(shown));
  return figure;
}

}  // namespace stiffscope
