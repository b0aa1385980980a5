#include "app/figures/gap_bars.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/input/units.h"
#include "reports/diagnosis_words.h"
#include "reports/page/html.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

const WhereTable* byPosture(const std::vector<WhereTable>& tables) {
  const auto found =
      std::find_if(tables.begin(), tables.end(), [](const WhereTable& one) { return one.by == "posture"; });
  return found == tables.end() ? nullptr : &*found;
}

std::vector<double> rmsOf(const WhereTable& table) {
  std::vector<double> values;
  for (const WhereRow& row : table.rows) values.push_back(row.rms / kMicrometre);
  return values;
}

}  // namespace

std::optional<GroupedBarChart> gapBars(const ReportCampaign& one) {
  if (one.diagnosis == nullptr || !one.diagnosis->usable) return std::nullopt;
  const WhereTable* before = byPosture(one.diagnosis->where);
  const WhereTable* after = byPosture(one.diagnosis->where_after);
  if (before == nullptr || before->rows.empty()) return std::nullopt;
  GroupedBarChart chart;
  chart.title = "Gap between model and machine";
  chart.subtitle = fmt::format("{}; verdict: {}", one.campaign.name, verdictWords(one.diagnosis->verdict));
  chart.y_title = "Left of the deflection, rms per coordinate (µm)";
  chart.category_title = "Posture";
  for (const WhereRow& row : before->rows) chart.categories.push_back(row.name);
  chart.series.push_back({"stiffnesses alone", colours::kNone, rmsOf(*before), {}});
  if (after != nullptr && after->rows.size() == before->rows.size() && !one.diagnosis->verdict.entries.empty()) {
    chart.series.push_back({"with the verdict's effects", colours::kSeries[1], rmsOf(*after), {}});
  }
  BarSeries noise{"noise alone", colours::kSeries[2], {}, {}};
  for (const WhereRow& row : before->rows) noise.values.push_back(row.noise / kMicrometre);
  chart.series.push_back(std::move(noise));
  return chart;
}

Figure describeGapBars(const ReportCampaign& one) {
  const Gap& gap = one.diagnosis->gap;
  Figure figure;
  figure.id = "gap-by-posture";
  figure.title = "Gap between model and machine, before and after";
  figure.caption = fmt::format(
      "Over all postures, rms per coordinate: {}\u00a0µm by joint stiffnesses alone, {}\u00a0µm with the verdict's "
      "effects in the model, {}\u00a0µm by noise alone. A posture that stays high is one where the verdict does not "
      "hold.",
      page::fixed(gap.before / kMicrometre, 1), page::fixed(gap.after / kMicrometre, 1),
      page::fixed(gap.noise / kMicrometre, 1));
  if (one.preparation != nullptr && one.preparation->drift.taken_off) {
    figure.caption +=
        " Bars are of readings with the station's motion taken off; the first figure is of the readings as they were.";
  }
  figure.alt = "Bars by posture: what the model leaves of the deflection before and after, and noise.";
  return figure;
}

}  // namespace stiffscope
