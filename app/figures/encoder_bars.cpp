#include "app/figures/encoder_bars.h"

#include <fmt/format.h>

#include <algorithm>

#include "reports/page/avoided_by_encoders.h"
#include "reports/page/html.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

constexpr double kMmPerM = 1e3;
constexpr Colour kActive{70, 78, 96};  // slate: no method's colour

}  // namespace

GroupedBarChart encoderBars(const AvoidedByEncoders& avoided) {
  GroupedBarChart chart;
  chart.title = fmt::format("Displacement of {} without and with double encoders", pointOf(avoided));
  chart.subtitle = fmt::format("{} of it avoided over {} postures; no compensation",
                               shareWords(avoided), avoided.postures.size());
  chart.y_title = fmt::format("Displacement of {} (mm)", pointOf(avoided));
  chart.category_title = "Posture";
  chart.series = {{"double encoders inactive", colours::kNone, {}, {}},
                  {"double encoders active", kActive, {}, {}}};
  for (const PostureDeflection& posture : avoided.postures) {
    chart.categories.push_back(page::asIs(posture.pose));
    chart.series[0].values.push_back(kMmPerM * posture.before);
    chart.series[1].values.push_back(kMmPerM * posture.after);
  }
  return chart;
}

Figure describeEncoderBars(const AvoidedByEncoders& avoided) {
  const auto [least, most] = std::minmax_element(
      avoided.postures.begin(), avoided.postures.end(),
      [](const PostureDeflection& a, const PostureDeflection& b) { return a.share() < b.share(); });
  Figure figure;
  figure.id = "double-encoders";
  figure.title = fmt::format("Displacement of {} without and with double encoders", pointOf(avoided));
  figure.caption = fmt::format(
      "Active double encoders avoid {} of the deflection in all; least in posture {} ({}), most in "
      "posture {} ({}).",
      shareWords(avoided), page::asIs(least->pose), page::percent(least->share(), 0), page::asIs(most->pose),
      page::percent(most->share(), 0));
  figure.alt = fmt::format(
      "Bars by posture: length of the displacement of {} with the double encoders inactive and active.",
      page::plain(pointOf(avoided)));
  return figure;
}

}  // namespace stiffscope
