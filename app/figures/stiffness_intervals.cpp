#include "app/figures/stiffness_intervals.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/figures/method_colours.h"
#include "reports/page/coverage.h"
#include "reports/page/html.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

Interval intervalOf(const StiffnessEstimate& estimate, int joint) {
  if (!estimate.identifiable[static_cast<std::size_t>(joint)]) return {};
  const double value = estimate.stiffness(joint), reach = page::coverageOf(estimate, joint).factor * estimate.stiffnessSd(joint);
  return {value, value - reach, value + reach, !estimate.mark(joint).empty()};
}

/// The joint on which the methods differ most, as the ratio of the largest to the smallest positive
/// stiffness.
std::string disagreement(const Identification& result) {
  double worst = 0.0;
  int at = -1;
  for (int joint = 0; joint < 6; ++joint) {
    std::vector<double> values;
    for (const Method method : kMethods) {
      const MethodResult& one = result.of(method);
      const bool there = one.available && one.estimate.identifiable[static_cast<std::size_t>(joint)];
      if (there && one.estimate.compliance[joint] > 0.0) values.push_back(one.estimate.stiffness(joint));
    }
    if (values.size() < 2) continue;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    if (*most / *least > worst) worst = *most / *least, at = joint;
  }
  if (at < 0) return {};
  return fmt::format(
      " The methods differ most on {}: by {}.", page::jointName(at),
      worst < 2.0 ? page::percent(worst - 1.0) : fmt::format("a factor of {}", page::significant(worst, 2)));
}

}  // namespace

IntervalChart stiffnessIntervals(const ReportCampaign& one) {
  IntervalChart chart;
  chart.title = "Joint stiffness by method";
  chart.subtitle = fmt::format("{}; {} postures; whiskers: expanded uncertainty U, about 95\u00a0%", page::asIs(one.campaign.name),
                               one.identification.cases.size());
  chart.y_title = "Stiffness (Nm/rad)";
  chart.category_title = "Joint";
  chart.logarithmic = true;
  for (int joint = 0; joint < 6; ++joint) {
    const bool seen = one.identification.identifiability.joints[static_cast<std::size_t>(joint)].identifiable;
    chart.categories.push_back(page::jointName(joint) + (seen ? "" : ": not seen"));
  }
  for (const Method method : kMethods) {
    const MethodResult& result = one.identification.of(method);
    if (!result.available) continue;
    IntervalSeries series{page::longName(method), colourOf(method), {}};
    for (int joint = 0; joint < 6; ++joint) {
      series.intervals.push_back(intervalOf(result.estimate, joint));
      if (series.intervals.back().doubtful) chart.doubtful_name = "negative or imprecise";
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

Figure describeStiffnessIntervals(const ReportCampaign& one) {
  std::vector<std::string> unseen;
  for (int joint = 0; joint < 6; ++joint) {
    const bool seen = one.identification.identifiability.joints[static_cast<std::size_t>(joint)].identifiable;
    if (!seen) unseen.push_back(page::jointName(joint));
  }
  Figure figure;
  figure.id = "stiffness";
  figure.title = "Joint stiffness by method";
  figure.caption = fmt::format("From all {} postures, with the expanded uncertainty U (about 95\u00a0%) either way.{}",
                               one.identification.cases.size(), disagreement(one.identification));
  if (!unseen.empty())
    figure.caption += fmt::format(" Not identifiable in this data: {}.", fmt::join(unseen, ", "));
  figure.alt = "Points with whiskers by joint and method: stiffness on a logarithmic axis.";
  return figure;
}

}  // namespace stiffscope
