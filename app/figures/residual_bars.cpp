#include "app/figures/residual_bars.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/figures/drawn_words.h"
#include "app/figures/method_colours.h"
#include "core/diagnosis/evenly_spread.h"
#include "reports/page/html.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

constexpr std::size_t kMostPostures = 200;  // four bars each are hardly a pixel wide

std::vector<double> drawnInMm(const std::vector<double>& values) {
  std::vector<double> drawn;
  for (const std::size_t i : evenlySpreadIndices(values.size(), kMostPostures)) drawn.push_back(kMmPerM * values[i]);
  return drawn;
}

/// How the bars were judged: "each posture by 10 of the others".
std::string judgedWords(const ReportCampaign& one) {
  for (const Method method : kMethods) {
    const SubsetStudy& study = one.identification.of(method).subsets;
    if (study.compliances.empty()) continue;
    return fmt::format("each posture by stiffnesses from {} of the others, mean over {} subsets", study.size,
                       study.every_subset ? "all" : "the drawn");
  }
  return fmt::format("identified from and judged on all {} postures", one.identification.cases.size());
}

GroupedBarChart emptyChart(const ReportCampaign& one, const char* what, const char* axis) {
  const page::JudgedPoint point = page::judgedPoint(one);
  GroupedBarChart chart;
  chart.title = fmt::format("{} of {}", what, point.name);
  chart.subtitle = fmt::format("{}; {}", page::asIs(one.campaign.name), judgedWords(one));
  chart.y_title = fmt::format("{} of {} (mm)", axis, point.name);
  chart.category_title = "Posture";
  for (const std::size_t i : evenlySpreadIndices(one.identification.cases.size(), kMostPostures)) {
    chart.categories.push_back(page::postureName(one, i));
  }
  return chart;
}

void addMethod(const ReportCampaign& one, Method method, GroupedBarChart& chart) {
  const MethodResult& result = one.identification.of(method);
  const bool at_wrist = page::judgedPoint(one).at_wrist;
  if (!result.available || page::residualAt(result, at_wrist).empty()) return;
  const std::vector<double> left = page::heldOutResidualAt(one, method, at_wrist);
  chart.series.push_back({fmt::format("after {}", page::longName(method)), colourOf(method), drawnInMm(left), {}});
}

/// Which postures are drawn where not all are, and the longest bar of all.
std::string drawnOf(const ReportCampaign& one, const std::vector<double>& values) {
  const std::string words = drawnWords(values.size(), kMostPostures, "postures");
  if (words.empty()) return {};
  const auto longest = std::max_element(values.begin(), values.end());
  return fmt::format("{} The longest of all is {}\u00a0mm, in posture {}.", words, page::fixed(kMmPerM * *longest, 2),
                     page::postureName(one, static_cast<std::size_t>(longest - values.begin())));
}

/// "CP leaves 0.12, PP 0.08 and DPP 0.05 mm in the mean"
std::string leftWords(const ReportCampaign& one, std::initializer_list<Method> methods) {
  const bool at_wrist = page::judgedPoint(one).at_wrist;
  std::vector<std::string> parts;
  for (const Method method : methods) {
    const MethodResult& result = one.identification.of(method);
    if (!result.available) continue;
    parts.push_back(fmt::format(
        "{} {}", page::shortName(method),
        page::significant(kMmPerM * page::mean(page::heldOutResidualAt(one, method, at_wrist)), 2)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

GroupedBarChart residualBars(const ReportCampaign& one) {
  GroupedBarChart chart = emptyChart(one, "Displacement", "Displacement");
  const bool at_wrist = page::judgedPoint(one).at_wrist;
  chart.series.push_back(
      {"without compensation", colours::kNone, drawnInMm(page::displacementAt(one.identification, at_wrist)), {}});
  for (const Method method : kMethods) addMethod(one, method, chart);
  return chart;
}

GroupedBarChart residualZoom(const ReportCampaign& one) {
  GroupedBarChart chart = emptyChart(one, "What is left of the displacement", "Left of the displacement");
  for (const Method method : {Method::partial_pose, Method::decoupled_partial_pose})
    addMethod(one, method, chart);
  return chart;
}

Figure describeResidualBars(const ReportCampaign& one) {
  const page::JudgedPoint point = page::judgedPoint(one);
  Figure figure;
  figure.id = "compensation";
  figure.title = fmt::format("Displacement of {} before and after compensation", point.name);
  figure.caption = fmt::format(
      "Mean over the postures: {}\u00a0mm without compensation (grey).",
      page::fixed(kMmPerM * page::mean(page::displacementAt(one.identification, point.at_wrist)), 2));
  const std::string left =
      leftWords(one, {Method::complete_pose, Method::partial_pose, Method::decoupled_partial_pose});
  if (!left.empty()) figure.caption += fmt::format(" Left after compensation, in mm: {}.", left);
  figure.caption += drawnOf(one, page::displacementAt(one.identification, point.at_wrist));
  figure.caption += " The counterpart of the paper's Fig. 7.";
  figure.alt = fmt::format(
      "Bars by posture: length of the displacement of {}, without compensation and after each method.",
      page::plain(point.name));
  return figure;
}

Figure describeResidualZoom(const ReportCampaign& one) {
  const page::JudgedPoint point = page::judgedPoint(one);
  Figure figure;
  figure.id = "compensation-zoom";
  figure.title = fmt::format("What PP and DPP leave of the displacement of {}", point.name);
  figure.caption = fmt::format("The same as the figure before, enlarged. Mean over the postures, in mm: {}.",
                               leftWords(one, {Method::partial_pose, Method::decoupled_partial_pose}));
  figure.caption += " The counterpart of the paper's Fig. 8.";
  figure.alt = fmt::format("Bars by posture: what is left of the displacement of {} after PP and DPP.",
                           page::plain(point.name));
  return figure;
}

}  // namespace stiffscope
