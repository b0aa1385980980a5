#include "app/figures/gap_bars.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/diagnosis/evenly_spread.h"
#include "core/input/units.h"
#include "reports/page/effect_words.h"
#include "reports/page/html.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

const WhereTable* byPosture(const std::vector<WhereTable>& tables) {
  const auto found =
      std::find_if(tables.begin(), tables.end(), [](const WhereTable& one) { return one.by == "posture"; });
  return found == tables.end() ? nullptr : &*found;
}

/// Whether the verdict names something that can be in a model.
bool named(const ReportCampaign& one) { return !page::namedWords(one.diagnosis->verdict).empty(); }

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
  chart.subtitle = fmt::format("{}; in the verdict: {}", page::asIs(one.campaign.name),
                               page::asIs(page::presentWords(one.diagnosis->verdict)));
  chart.y_title = "Left of the deflection, rms per coordinate (µm)";
  chart.category_title = "Posture";
  for (const WhereRow& row : before->rows) chart.categories.push_back(page::asIs(row.name));
  const WhereTable& as_measured = one.diagnosis->as_measured;
  const bool raw = as_measured.rows.size() == before->rows.size();  // the station's motion is part of the gap
  chart.series.push_back({"joint stiffnesses alone", colours::kNone, rmsOf(raw ? as_measured : *before), {}});
  if (after != nullptr && after->rows.size() == before->rows.size() && named(one)) {
    chart.series.push_back({"with the verdict's effects", colours::kSeries[1], rmsOf(*after), {}});
  }
  BarSeries noise{"noise alone", colours::kSeries[2], {}, {}};
  for (const WhereRow& row : before->rows) noise.values.push_back(row.noise / kMicrometre);
  chart.series.push_back(std::move(noise));
  return chart;
}

Figure describeGapBars(const ReportCampaign& one) {
  const Gap& gap = one.diagnosis->gap;
  const bool found = named(one);
  Figure figure;
  figure.id = "gap-by-posture";
  figure.title = found ? "Gap between model and machine, before and after" : "Gap between model and machine";
  figure.caption = fmt::format(
      "Over {} postures, rms per coordinate: {}\u00a0µm by joint stiffnesses alone, {}{}\u00a0µm by noise "
      "alone.",
      one.campaign.pose_ids.size() > kMostDiagnosed
          ? fmt::format("{} of {}", one.diagnosis->postures, one.campaign.pose_ids.size())
          : "all",
      page::fixed(gap.before / kMicrometre, 1),
      found ? fmt::format("{}\u00a0µm with the verdict's effects in the model, ",
                          page::fixed(gap.after / kMicrometre, 1))
            : "",
      page::fixed(gap.noise / kMicrometre, 1));
  figure.caption += found
                        ? " A posture that stays high is one where the verdict does not hold."
                        : " Postures that stand out of the noise show what joint stiffnesses do not explain.";
  if (!one.diagnosis->as_measured.rows.empty())
    figure.caption += " Grey bars are of the readings as they were, the station's motion in them.";
  figure.alt = "Bars by posture: what the model leaves of the deflection before and after, and noise.";
  return figure;
}

}  // namespace stiffscope
