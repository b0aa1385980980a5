#include "app/figures/subset_spreads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/figures/method_colours.h"
#include "core/identification/stiffness_spread.h"
#include "reports/page/html.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"
#include "reports/page/paper_values.h"

namespace stiffscope {

namespace {

constexpr double kMega = 1e6;

bool hasSpread(const MethodResult& method, int joint) {
  return method.available && !method.subsets.compliances.empty() &&
         method.estimate.identifiable[static_cast<std::size_t>(joint)];
}

std::optional<Spread> spreadIn(const MethodResult& method, int joint) {
  if (!hasSpread(method, joint)) return std::nullopt;
  const StiffnessSpread spread = spreadOf(method.subsets, joint);
  if (!std::isfinite(spread.mean)) return std::nullopt;
  return Spread{spread.low / kMega,           spread.quartile_low / kMega, spread.median / kMega,
                spread.quartile_high / kMega, spread.high / kMega,         spread.mean / kMega};
}

/// Whether a reference can be drawn without squashing the boxes: within three widths of what they cover.
bool fits(const SpreadPanel& panel, double reference) {
  double low = INFINITY, high = -INFINITY;
  for (const auto& spread : panel.spreads) {
    if (!spread) continue;
    low = std::min(low, spread->p5);
    high = std::max(high, spread->p95);
  }
  const double reach = 3.0 * (high - low);
  return reference >= low - reach && reference <= high + reach;
}

std::string subsetsOf(const ReportCampaign& one) {
  const auto shown = page::shownMethod(one.identification);
  return shown ? page::subsetWords(one.identification.of(*shown).subsets) : std::string();
}

}  // namespace

SpreadChart subsetSpreads(const ReportCampaign& one, bool with_paper) {
  SpreadChart chart;
  chart.title = fmt::format("Joint stiffness over {}", subsetsOf(one));
  chart.subtitle = page::asIs(one.campaign.name);
  chart.y_title = "Stiffness (10⁶ Nm/rad)";
  std::vector<Method> methods;
  for (const Method method : kMethods) {
    const MethodResult& result = one.identification.of(method);
    if (!result.available || result.subsets.compliances.empty()) continue;
    methods.push_back(method);
    chart.methods.push_back({page::longName(method), colourOf(method)});
  }
  for (int joint = 0; joint < 6; ++joint) {
    SpreadPanel panel;
    panel.title = page::jointName(joint);
    for (const Method method : methods)
      panel.spreads.push_back(spreadIn(one.identification.of(method), joint));
    for (const Method method : methods) {
      if (!with_paper) break;
      const auto paper = page::paperStiffness(one.campaign.double_encoder, method, joint);
      const bool drawn = paper && fits(panel, paper->mean);
      panel.references.push_back(drawn ? std::optional<double>(paper->mean) : std::nullopt);
      if (drawn) chart.reference_name = "mean in the paper's Table II, where it is near";
    }
    const bool any =
        std::any_of(panel.spreads.begin(), panel.spreads.end(), [](const auto& s) { return s.has_value(); });
    if (any) chart.panels.push_back(std::move(panel));
  }
  return chart;
}

Figure describeSubsetSpreads(const ReportCampaign& one) {
  Figure figure;
  figure.id = "subsets";
  figure.title = "Spread of the joint stiffnesses over subsets of postures";
  figure.caption =
      fmt::format("Over {}. Half of the range from 5 to 95\u00a0% as a share of the median:", subsetsOf(one));
  std::vector<std::string> parts;
  for (const Method method : kMethods) {
    double widest = 0.0;
    int at = -1;
    for (int joint = 0; joint < 6; ++joint) {
      const MethodResult& result = one.identification.of(method);
      if (!hasSpread(result, joint)) continue;
      const StiffnessSpread spread = spreadOf(result.subsets, joint);
      const double width = 0.5 * (spread.high - spread.low) / std::abs(spread.median);
      if (at < 0 || width > widest) widest = width, at = joint;
    }
    if (at >= 0) {
      parts.push_back(fmt::format("{} at most {} ({})", page::shortName(method),
                                  page::percent(widest, widest < 0.1 ? 1 : 0), page::jointName(at)));
    }
  }
  figure.caption +=
      fmt::format(" {}. Narrow boxes mean that the postures drawn hardly matter.", fmt::join(parts, ", "));
  figure.alt = "Boxes by joint and method: the distribution of the stiffness over the subsets of postures.";
  return figure;
}

}  // namespace stiffscope
