#include "app/figures/figures.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "app/figures/chart_style.h"
#include "core/identification/estimate.h"
#include "core/identification/subsets.h"
#include "reports/page/html.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/paper_values.h"

namespace stiffscope::app {

namespace {

int jointsOf(const identification::Identification& result) {
  return static_cast<int>(result.identifiability.joints.size());
}

render::Interval intervalOf(const identification::StiffnessEstimate& estimate, int joint) {
  if (!estimate.identifiable[static_cast<std::size_t>(joint)]) return {};
  const double value = estimate.stiffness(joint);
  const bool doubtful = !estimate.mark(joint).empty();
  if (!estimate.stated.empty()) {
    const identification::CoverageInterval interval = identification::stiffnessInterval(estimate, joint);
    return {value, interval.low, interval.high, doubtful};
  }
  const double reach = identification::expandedUncertainty(estimate, joint);
  return {value, value - reach, value + reach, doubtful};
}

/// The joint on which the methods differ most, as the ratio of the largest to the smallest positive
/// stiffness.
std::string disagreement(const identification::Identification& result) {
  double worst = 0.0;
  int at = -1;
  for (int joint = 0; joint < jointsOf(result); ++joint) {
    std::vector<double> values;
    for (const identification::Method method : identification::kMethods) {
      const identification::MethodResult& one = result.of(method);
      const bool there = one.available && one.estimate.identifiable[static_cast<std::size_t>(joint)];
      if (there && one.estimate.compliance[joint] > 0.0) values.push_back(one.estimate.stiffness(joint));
    }
    if (values.size() < 2) continue;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    if (*most / *least > worst) worst = *most / *least, at = joint;
  }
  if (at < 0) return {};
  return fmt::format(
      " The methods differ most on {}: by {}.", reports::jointName(at),
      worst < 2.0 ? reports::percent(worst - 1.0) : fmt::format("a factor of {}", reports::significant(worst, 2)));
}

}  // namespace

render::IntervalChart stiffnessIntervals(const reports::ReportCampaign& one) {
  render::IntervalChart chart;
  chart.title = "Joint stiffness by method";
  chart.subtitle = fmt::format("{}; {} postures; whiskers: 95\u00a0% intervals", reports::asIs(one.campaign.name),
                               one.identification.cases.size());
  chart.y_title = "Stiffness (Nm/rad)";
  chart.category_title = "Joint";
  chart.logarithmic = true;
  for (int joint = 0; joint < jointsOf(one.identification); ++joint) {
    const bool seen = one.identification.identifiability.joints[static_cast<std::size_t>(joint)].identifiable;
    chart.categories.push_back(reports::jointName(joint) + (seen ? "" : ": not seen"));
  }
  for (const identification::Method method : identification::kMethods) {
    const identification::MethodResult& result = one.identification.of(method);
    if (!result.available) continue;
    render::IntervalSeries series{reports::longName(method), colourOf(method), {}};
    for (int joint = 0; joint < jointsOf(one.identification); ++joint) {
      series.intervals.push_back(intervalOf(result.estimate, joint));
      if (series.intervals.back().doubtful) chart.doubtful_name = "negative or imprecise";
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

reports::Figure describeStiffnessIntervals(const reports::ReportCampaign& one) {
  std::vector<std::string> unseen;
  for (int joint = 0; joint < jointsOf(one.identification); ++joint) {
    const bool seen = one.identification.identifiability.joints[static_cast<std::size_t>(joint)].identifiable;
    if (!seen) unseen.push_back(reports::jointName(joint));
  }
  reports::Figure figure;
  figure.id = "stiffness-intervals";
  figure.title = "Joint stiffness by method";
  figure.caption = fmt::format("From all {} postures, with 95\u00a0% intervals; U is the longer side of each.{}",
                               one.identification.cases.size(), disagreement(one.identification));
  if (!unseen.empty()) figure.caption += fmt::format(" Not identifiable in this data: {}.", fmt::join(unseen, ", "));
  figure.alt = "Points with whiskers by joint and method: stiffness on a logarithmic axis.";
  return figure;
}

namespace {

bool hasSpread(const identification::MethodResult& method, int joint) {
  return method.available && !method.subsets.compliances.empty() &&
         method.estimate.identifiable[static_cast<std::size_t>(joint)];
}

std::optional<render::Spread> spreadIn(const identification::MethodResult& method, int joint,
                                       const reports::StiffnessUnit& unit) {
  if (!hasSpread(method, joint)) return std::nullopt;
  const identification::StiffnessSpread spread = identification::spreadOf(method.subsets, joint);
  // A compliance of zero in one subset is an infinite stiffness there.
  for (const double one :
       {spread.low, spread.quartile_low, spread.median, spread.quartile_high, spread.high, spread.mean})
    if (!std::isfinite(one)) return std::nullopt;
  return render::Spread{spread.low / unit.size,           spread.quartile_low / unit.size, spread.median / unit.size,
                        spread.quartile_high / unit.size, spread.high / unit.size,         spread.mean / unit.size};
}

/// Whether a reference can be drawn without squashing the boxes: within three widths of what they cover.
bool fits(const render::SpreadPanel& panel, double reference) {
  double low = INFINITY, high = -INFINITY;
  for (const auto& spread : panel.spreads) {
    if (!spread) continue;
    low = std::min(low, spread->p5);
    high = std::max(high, spread->p95);
  }
  const double reach = 3.0 * (high - low);
  return reference >= low - reach && reference <= high + reach;
}

std::string subsetsOf(const reports::ReportCampaign& one) {
  const auto shown = reports::shownMethod(one.identification);
  return shown ? reports::subsetWords(one.identification.of(*shown).subsets) : std::string();
}

}  // namespace

render::SpreadChart subsetSpreads(const reports::ReportCampaign& one, bool with_paper) {
  render::SpreadChart chart;
  chart.title = fmt::format("Joint stiffness over {}", subsetsOf(one));
  chart.subtitle = reports::asIs(one.campaign.name);
  const reports::StiffnessUnit unit = reports::stiffnessUnit(one.identification);
  std::string name = unit.name;  // a picture has no line to break
  if (const std::string gap = "\u00a0"; name.find(gap) != std::string::npos)
    name.replace(name.find(gap), gap.size(), " ");
  chart.y_title = fmt::format("Stiffness ({})", name);
  std::vector<identification::Method> methods;
  for (const identification::Method method : identification::kMethods) {
    const identification::MethodResult& result = one.identification.of(method);
    if (!result.available || result.subsets.compliances.empty()) continue;
    methods.push_back(method);
    chart.methods.push_back({reports::longName(method), colourOf(method)});
  }
  for (int joint = 0; joint < jointsOf(one.identification); ++joint) {
    render::SpreadPanel panel;
    panel.title = reports::jointName(joint);
    for (const identification::Method method : methods)
      panel.spreads.push_back(spreadIn(one.identification.of(method), joint, unit));
    for (const identification::Method method : methods) {
      if (!with_paper) break;
      const auto paper = reports::paperStiffness(one.campaign, method, joint);
      const double mean = paper ? paper->mean * reports::kMega / unit.size : 0.0;
      const bool drawn = paper && fits(panel, mean);
      panel.references.push_back(drawn ? std::optional<double>(mean) : std::nullopt);
      if (drawn) chart.reference_name = "mean in the paper's Table II, where it is near";
    }
    const bool any =
        std::any_of(panel.spreads.begin(), panel.spreads.end(), [](const auto& s) { return s.has_value(); });
    if (any) chart.panels.push_back(std::move(panel));
  }
  return chart;
}

reports::Figure describeSubsetSpreads(const reports::ReportCampaign& one) {
  reports::Figure figure;
  figure.id = "subset-spreads";
  figure.title = "Spread of the joint stiffnesses over subsets of postures";
  figure.caption =
      fmt::format("Over {}. Half of the range from 5 to 95\u00a0% as a share of the median:", subsetsOf(one));
  std::vector<std::string> parts;
  for (const identification::Method method : identification::kMethods) {
    double widest = 0.0;
    int at = -1;
    for (int joint = 0; joint < jointsOf(one.identification); ++joint) {
      const identification::MethodResult& result = one.identification.of(method);
      if (!hasSpread(result, joint)) continue;
      const identification::StiffnessSpread spread = identification::spreadOf(result.subsets, joint);
      const double width = 0.5 * (spread.high - spread.low) / std::abs(spread.median);
      if (at < 0 || width > widest) widest = width, at = joint;
    }
    if (at >= 0) {
      parts.push_back(fmt::format("{} at most {} ({})", reports::shortName(method),
                                  reports::percent(widest, widest < 0.1 ? 1 : 0), reports::jointName(at)));
    }
  }
  figure.caption +=
      fmt::format(" {}. Narrow boxes mean that the postures drawn hardly matter.", fmt::join(parts, ", "));
  figure.alt = "Boxes by joint and method: the distribution of the stiffness over the subsets of postures.";
  return figure;
}

}  // namespace stiffscope::app
