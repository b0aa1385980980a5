#include "app/figures/figures.h"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

#include "app/figures/chart_style.h"
#include "core/io/units.h"
#include "reports/page/html.h"
#include "reports/words/effect_words.h"
#include "reports/words/numbers.h"

namespace stiffscope::app {

namespace {

/// The share of draws of which `count` says so, in percent, over the sizes.
render::PointSeries shareOf(const diagnosis::SpikedEffect& one, const char* name, std::size_t look, auto count) {
  render::PointSeries series = seriesLook(look);
  series.name = name;
  series.joined = true;
  for (std::size_t i = 0; i < one.sizes.size(); ++i) {
    const diagnosis::SpikeCounts& at = one.sizes[i];
    series.points.push_back({static_cast<double>(i), at.draws > 0 ? 100.0 * count(at) / at.draws : NAN});
  }
  return series;
}

/// Holds the axis of every panel from 0 to 100 %, drawing nothing.
render::PointSeries wholeAxis() {
  render::PointSeries series;
  series.mark = render::PointMark::none;
  series.points = {{0.0, 0.0}, {0.0, 100.0}};
  return series;
}

render::PointPanel spikePanel(const diagnosis::SpikedEffect& one) {
  using Counts = diagnosis::SpikeCounts;
  render::PointPanel panel;
  panel.title = fmt::format("{}{}: {}", reports::effectName(one.effect), one.in_baseline ? "*" : "",
                            reports::shownLength(*one.detectable, 2));
  panel.y_title = "Draws (%)";
  panel.x_title = "Times that size";
  for (const Counts& at : one.sizes) panel.categories.push_back(fmt::format("{:g}", at.times));
  render::PointSeries named = shareOf(one, "named", 0, [](const Counts& at) { return at.named; });
  named.mark = render::PointMark::ring;  // drawn last, and shows what lies under it
  panel.series = {wholeAxis(),
                  shareOf(one, "another named, or unknown", 1,
                          [](const Counts& at) { return std::min(at.draws, at.other_named + at.unknown); }),
                  shareOf(one, "named with its part", 2, [](const Counts& at) { return at.part_named; }),
                  std::move(named)};
  return panel;
}

}  // namespace

std::optional<render::PointChart> spikeCurves(const campaign::Campaign& campaign, const diagnosis::Diagnosis& baseline,
                                              const diagnosis::SpikeStudy& study) {
  render::PointChart chart;
  chart.title = "How often an effect is named that was added to this day's own readings";
  chart.subtitle = fmt::format("{}; without any: {}; {} draws a size", reports::asIs(campaign.name),
                               reports::asIs(reports::presentWords(baseline.verdict)), study.draws);
  chart.columns = 4;
  bool marked = false;
  for (const diagnosis::SpikedEffect& one : study.effects) {
    if (!one.detectable) continue;
    chart.diagrams.push_back(spikePanel(one));
    marked = marked || one.in_baseline;
  }
  if (chart.diagrams.empty()) return std::nullopt;
  chart.columns = std::min<int>(chart.columns, static_cast<int>(chart.diagrams.size()));
  chart.note = "Beside each name: the smallest size that would have been seen.";
  if (marked) chart.note += " * named without being added.";
  return chart;
}

}  // namespace stiffscope::app
