#include "app/figures/result_charts.h"

#include <fmt/format.h>
#include <algorithm>

#include "render/point_chart.h"
#include "reports/words/fleet_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/rich_text.h"

namespace stiffscope::app {

namespace {

constexpr std::size_t kMostCategories = 60;  // that a panel has place for; of more the last

/// Dates without the year where they have one in common: a panel has place for few letters.
std::vector<std::string> shortDates(const fleet::Fleet& fleet, const std::vector<std::size_t>& days) {
  std::vector<std::string> dates;
  for (const std::size_t one : days) dates.push_back(fleet.campaigns[one].date);
  const std::string year = dates.front().substr(0, dates.front().find('-') + 1);
  const bool common =
      std::all_of(dates.begin(), dates.end(), [&](const std::string& one) { return one.starts_with(year); });
  if (common) {
    for (std::string& one : dates) one.erase(0, year.size());
  }
  return dates;
}

render::PointPanel controlPanel(const fleet::Fleet& fleet, const fleet::SeriesCharts& charts, std::size_t joint) {
  const fleet::ControlChart& chart = charts.joints[joint];
  const std::vector<std::size_t>& days = fleet.series[charts.series].campaigns;
  render::PointPanel panel;
  panel.title = fmt::format("Joint {}, {}·10⁻⁶ rad/Nm", joint + 1, reports::significant(1e6 * chart.centre, 3));
  panel.y_title = "Change (%)";
  render::PointSeries inside, outside, upper, lower;
  inside.name = "within limits", inside.colour = render::colours::kSeries[0];
  outside.name = "outside", outside.colour = render::colours::kSeries[1], outside.mark = render::PointMark::diamond;
  upper.name = "limits", upper.colour = render::colours::kAxis, upper.mark = render::PointMark::none,
  upper.joined = true;
  lower = upper;
  const std::vector<std::string> dates = shortDates(fleet, days);
  const std::size_t first = days.size() > kMostCategories ? days.size() - kMostCategories : 0;
  for (std::size_t t = first; t < days.size(); ++t) {
    const fleet::ControlChart::Point& point = chart.points[t];
    const double x = static_cast<double>(t - first);
    panel.categories.push_back(reports::asIs(dates[t]));
    render::PointSeries& own = point.outside ? outside : inside;
    own.points.push_back({x, 100.0 * point.value});
    own.errors.push_back(std::isfinite(point.expanded) ? 100.0 * point.expanded : 0.0);
    upper.points.push_back({x, 100.0 * point.limit});
    lower.points.push_back({x, -100.0 * point.limit});
  }
  panel.series = {upper, lower, inside};
  if (!outside.points.empty()) panel.series.push_back(outside);
  return panel;
}

std::string changesOf(const fleet::Fleet& fleet, std::size_t series) {
  std::string words;
  for (const fleet::FleetStep& step : fleet.steps) {
    if (step.series != series || step.what != fleet::FleetStep::What::compliance) continue;
    words += fmt::format("{}joint {} from {} on", words.empty() ? "Changed: " : ", ", step.compliance.joint + 1,
                         fleet.campaigns[step.campaign].date);
  }
  return words.empty() ? "No joint has changed." : words + ".";
}

reports::Figure controlFigure(const fleet::Fleet& fleet, const fleet::SeriesCharts& charts, std::size_t number) {
  const fleet::DaySeries& series = fleet.series[charts.series];
  const std::string encoders = reports::encoderWords(series.encoders);
  render::PointChart chart;
  chart.title = reports::asIs(reports::machineWords(fleet, series)) + (encoders.empty() ? "" : ", " + encoders);
  chart.subtitle = (charts.method ? reports::longName(*charts.method) + ", joint springs alone"
                                  : std::string("Calibration, by the arm's own weight")) +
                   (charts.same_postures ? "" : "; postures are not the same on all dates");
  chart.columns = 3;
  for (std::size_t joint = 0; joint < charts.joints.size(); ++joint) {
    if (!charts.joints[joint].points.empty()) chart.diagrams.push_back(controlPanel(fleet, charts, joint));
  }
  if (chart.diagrams.empty()) return {};
  constexpr int kPanelWidth = 400, kPanelHeight = 260, kAround = 190;
  chart.columns = std::min<int>(chart.columns, static_cast<int>(chart.diagrams.size()));
  const int rows = (static_cast<int>(chart.diagrams.size()) + chart.columns - 1) / chart.columns;
  reports::Figure figure;
  figure.width = std::max(1000, kPanelWidth * chart.columns), figure.height = kAround + kPanelHeight * rows;
  figure.png = render::encodePng(render::render(chart, {figure.width, figure.height}));
  figure.id = fmt::format("control-{}", number);
  figure.title = chart.title;
  figure.caption = reports::asIs(changesOf(fleet, charts.series));
  figure.alt = "Control charts of " + reports::machineWords(fleet, series) + ", joint by joint. " +
               changesOf(fleet, charts.series);
  return figure;
}

}  // namespace

std::vector<reports::Figure> fleetCharts(const fleet::Fleet& fleet) {
  std::vector<reports::Figure> figures;
  for (const fleet::Machine& machine : fleet.machines) {
    for (const fleet::SeriesCharts& charts : fleet.charts) {
      const fleet::DaySeries& series = fleet.series[charts.series];
      if (series.machine != machine.name || series.campaigns.size() < 2) continue;
      if (figures.size() == kMostFleetCharts) return figures;
      reports::Figure figure = controlFigure(fleet, charts, figures.size() + 1);
      if (!figure.png.empty()) figures.push_back(std::move(figure));
    }
  }
  return figures;
}

}  // namespace stiffscope::app
