#include "core/numerics/resampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/numerics/distributions.h"

namespace stiffscope::numerics {

double quantile(const std::vector<double>& ascending, double share) {
  const double place = share * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  return ascending[below] + (place - static_cast<double>(below)) * (ascending[above] - ascending[below]);
}

double quantileOf(std::vector<double> values, double share) {
  // The two that `quantile` looks at are brought to their places.
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), below, values.end());
  if (below + 1 != values.end()) std::iter_swap(below + 1, std::min_element(below + 1, values.end()));
  return quantile(values, share);
}

std::pair<double, double> shortestInterval(const std::vector<double>& ascending, double share) {
  constexpr int kSteps = 10;
  std::pair best{ascending.front(), ascending.back()};
  for (int step = 0; step <= kSteps; ++step) {
    const double below = (1.0 - share) * step / kSteps;
    const std::pair one{quantile(ascending, below), quantile(ascending, std::min(1.0, below + share))};
    if (one.second - one.first < best.second - best.first) best = one;
  }
  return best;
}

double upperMedian(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

Weights drawWeights(std::mt19937_64& random, std::size_t count) {
  Weights weights(count, 0.0);
  drawWithReplacement(random, count, [&](std::size_t index) { weights[index] += 1.0; });
  return weights;
}

double spreadOfFew(double count) {
  constexpr double kTail = 0.05;
  return std::sqrt(count / (count - 1.0)) * studentLimit(kTail, count - 1.0) / normalLimit(kTail);
}

BootstrapSpread bootstrapSpread(std::vector<double> draws, double count) {
  if (draws.empty()) return {};
  std::sort(draws.begin(), draws.end());
  constexpr double kTail = 0.025;
  const double middle = quantile(draws, 0.5), wider = spreadOfFew(std::max(2.0, count));
  return {middle, wider * (middle - quantile(draws, kTail)), wider * (quantile(draws, 1.0 - kTail) - middle)};
}

Weights leaveOneOut(std::size_t count, std::size_t left_out) {
  Weights weights(count, 1.0);
  weights[left_out] = 0.0;
  return weights;
}

std::uint64_t subsetCount(int n, int m) {
  std::uint64_t count = 1;
  for (int i = 1; i <= m; ++i) {
    const auto factor = static_cast<std::uint64_t>(n - m + i);
    if (count > std::numeric_limits<std::uint64_t>::max() / factor) return std::numeric_limits<std::uint64_t>::max();
    count = count * factor / static_cast<std::uint64_t>(i);
  }
  return count;
}

SubsetDraws::SubsetDraws(std::size_t count, std::size_t size, std::uint64_t seed)
    : random_(seed), order_(count), size_(size) {
  std::iota(order_.begin(), order_.end(), std::uint32_t{0});
}

std::span<const std::uint32_t> SubsetDraws::next() {
  for (std::size_t i = 0; i < size_; ++i) {
    std::swap(order_[i], order_[i + randomIndex(random_, order_.size() - i)]);
  }
  return std::span(order_).first(size_);
}

void forEachSubset(int n, int m, std::uint64_t most, std::uint64_t seed,
                   const std::function<void(const Weights&)>& visit) {
  const auto count = static_cast<std::size_t>(n), size = static_cast<std::size_t>(m);
  Weights used(count, 0.0);
  if (subsetCount(n, m) <= most) {
    std::fill_n(used.begin(), size, 1.0);
    do visit(used);
    while (std::prev_permutation(used.begin(), used.end()));
    return;
  }
  SubsetDraws draws(count, size, seed);
  for (std::uint64_t draw = 0; draw < most; ++draw) {
    std::fill(used.begin(), used.end(), 0.0);
    for (const std::uint32_t posture : draws.next()) used[posture] = 1.0;
    visit(used);
  }
}

}  // namespace stiffscope::numerics
