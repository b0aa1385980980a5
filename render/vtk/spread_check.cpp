#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "render/vtk/spread_range.h"

namespace stiffscope {

void requireConsistent(const SpreadChart& chart) {
  if (chart.methods.empty() || chart.panels.empty()) {
    throw std::invalid_argument(
        fmt::format("spread chart '{}' has {} methods and {} panels, expected one of each at least",
                    chart.title, chart.methods.size(), chart.panels.size()));
  }
  for (const SpreadPanel& panel : chart.panels) {
    const bool references_fit = panel.references.empty() || panel.references.size() == chart.methods.size();
    if (panel.spreads.size() != chart.methods.size() || !references_fit) {
      throw std::invalid_argument(fmt::format(
          "spread chart '{}': panel '{}' has {} spreads and {} references for {} methods", chart.title,
          panel.title, panel.spreads.size(), panel.references.size(), chart.methods.size()));
    }
    for (const auto& spread : panel.spreads) {
      if (!spread) continue;
      const std::array p = {spread->p5, spread->p25, spread->p50, spread->p75, spread->p95};
      const bool finite = std::isfinite(spread->mean) &&
                          std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x); });
      if (!finite || !std::is_sorted(p.begin(), p.end())) {
        throw std::invalid_argument(
            fmt::format("spread chart '{}': panel '{}' has percentiles {} {} {} {} {} and mean {}, "
                        "expected finite numbers, the percentiles in order",
                        chart.title, panel.title, p[0], p[1], p[2], p[3], p[4], spread->mean));
      }
    }
  }
}

}  // namespace stiffscope
