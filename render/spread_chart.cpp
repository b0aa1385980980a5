#include "render/spread_chart.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace stiffscope::render {

Spread spreadOf(std::vector<double> samples) {
  if (samples.empty()) throw std::invalid_argument("spread of no samples");
  if (!std::all_of(samples.begin(), samples.end(), [](double x) { return std::isfinite(x); })) {
    throw std::invalid_argument("spread of samples of which one is not finite");
  }
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
  std::sort(samples.begin(), samples.end());
  const auto percentile = [&samples](double p) {
    const double rank = p / 100 * static_cast<double>(samples.size() - 1);
    const auto below = static_cast<std::size_t>(rank);
    const auto above = std::min(below + 1, samples.size() - 1);
    return std::lerp(samples[below], samples[above], rank - std::floor(rank));
  };
  return {percentile(5), percentile(25), percentile(50), percentile(75), percentile(95), mean};
}

}  // namespace stiffscope::render
