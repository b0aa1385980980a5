#include "app/figures/result_charts.h"

#include <fmt/format.h>
#include <cmath>

#include "app/figures/drawn.h"
#include "render/grouped_bar_chart.h"
#include "render/interval_chart.h"
#include "reports/words/names.h"
#include "reports/words/rich_text.h"
#include "reports/words/stated_comparison_words.h"

namespace stiffscope::app {

namespace {

using reports::StatedCampaign;
using reports::StatedComparison;

constexpr render::Size kStatedChart{1200, 700};
constexpr std::size_t kMostGroups = 60;

render::Interval statedInterval(const std::optional<comparison::StatedCompliance>& compliance) {
  if (!compliance) return {};
  const identification::CoverageInterval k = identification::stiffnessInterval(compliance->interval);
  const double value = 1.0 / compliance->value;
  if (!k.holds(value)) return {};
  return {value, k.low, k.high, false};
}

reports::Figure stiffnessFigure(const StatedComparison& comparison) {
  const auto method = *comparison.shown_first;
  const std::size_t m = static_cast<std::size_t>(method);
  render::IntervalChart chart;
  chart.title = "Joint stiffness before and after";
  chart.subtitle = reports::longName(method) + "; whiskers: 95\u00a0% intervals";
  chart.y_title = "Stiffness (Nm/rad)";
  chart.category_title = "Joint";
  chart.logarithmic = true;
  chart.series = {{"before", render::colours::kSeries[0], {}}, {"after", render::colours::kSeries[1], {}}};
  for (std::size_t j = 0; j < comparison.changes[m].size(); ++j) {
    const auto& change = comparison.changes[m][j];
    chart.categories.push_back(reports::jointName(static_cast<int>(j)) + (change && change->significant() ? " *" : ""));
    chart.series[0].intervals.push_back(statedInterval(comparison.before.compliances[m][j]));
    chart.series[1].intervals.push_back(statedInterval(comparison.after.compliances[m][j]));
  }
  reports::Figure figure;
  figure.id = "stiffness-both";
  figure.title = chart.title;
  figure.caption = "A star: the difference is significant. " + reports::changedWords(comparison);
  figure.alt = "Stiffness of each joint before and after with its interval. " + reports::changedWords(comparison);
  figure.section = "stiffness";
  return drawn(std::move(figure), chart, kStatedChart);
}

reports::Figure postureFigure(const StatedComparison& comparison) {
  const std::size_t m = static_cast<std::size_t>(*comparison.shown_first);
  render::GroupedBarChart chart;
  chart.title = "What is left in each posture";
  chart.subtitle = reports::longName(*comparison.shown_first);
  chart.y_title = std::string("Residual at ") + (comparison.at_wrist ? "P_{wrist}" : "the reflectors") + " (mm)";
  chart.category_title = "Posture";
  chart.series = {{"before", render::colours::kSeries[0], {}, {}}, {"after", render::colours::kSeries[1], {}, {}}};
  for (const StatedComparison::Pair& pair : comparison.postures) {
    const reports::StatedPosture &before = comparison.before.postures[pair.before],
                                 &after = comparison.after.postures[pair.after];
    const double left_before = (comparison.at_wrist ? before.wrist : before.targets).residual_mm[m];
    const double left_after = (comparison.at_wrist ? after.wrist : after.targets).residual_mm[m];
    if (chart.categories.size() == kMostGroups || !std::isfinite(left_before) || !std::isfinite(left_after)) continue;
    chart.categories.push_back(reports::asIs(before.pose));
    chart.series[0].values.push_back(left_before);
    chart.series[1].values.push_back(left_after);
  }
  reports::Figure figure;
  if (chart.categories.empty()) return figure;
  figure.id = "postures-both";
  figure.title = chart.title;
  figure.caption = "The residual of each posture that both measured.";
  figure.alt = "Bars of the residual before and after in each posture.";
  figure.section = "postures";
  return drawn(std::move(figure), chart, kStatedChart);
}

}  // namespace

std::vector<reports::Figure> statedCharts(const StatedComparison& comparison) {
  std::vector<reports::Figure> figures;
  if (!comparison.comparesStiffness()) return figures;
  figures.push_back(stiffnessFigure(comparison));
  if (reports::Figure postures = postureFigure(comparison); !postures.png.empty())
    figures.push_back(std::move(postures));
  return figures;
}

}  // namespace stiffscope::app
