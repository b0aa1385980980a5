#include "core/identification/stiffness_spread.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stiffscope {

namespace {

/// The order statistics at `shares` (ascending), each by partitioning only what lies above the one before.
template <std::size_t N>
std::array<double, N> quantiles(std::vector<double>& values, const std::array<double, N>& shares) {
  std::array<double, N> found{};
  auto from = values.begin();
  for (std::size_t k = 0; k < N; ++k) {
    const auto at = values.begin() + std::lround(shares[k] * static_cast<double>(values.size() - 1));
    std::nth_element(from, at, values.end());
    found[k] = *at;
    from = at;
  }
  return found;
}

}  // namespace

StiffnessSpread spreadOf(const SubsetStudy& study, int joint) {
  StiffnessSpread spread;
  std::vector<double> stiffness;
  stiffness.reserve(study.compliances.size());
  double sum = 0.0, square = 0.0, c_sum = 0.0, c_square = 0.0;
  for (const Vector6d& compliance : study.compliances) {
    const double c = compliance[joint], k = 1.0 / c;
    stiffness.push_back(k);
    sum += k;
    c_sum += c;
    if (c < 0.0) spread.share_negative += 1.0;
  }
  const double n = static_cast<double>(stiffness.size());
  if (stiffness.size() < 2) return spread;
  spread.mean = sum / n;
  spread.compliance_mean = c_sum / n;
  for (const Vector6d& compliance : study.compliances) {
    square += std::pow(1.0 / compliance[joint] - spread.mean, 2);
    c_square += std::pow(compliance[joint] - spread.compliance_mean, 2);
  }
  spread.sd = std::sqrt(square / (n - 1.0));
  spread.compliance_sd = std::sqrt(c_square / (n - 1.0));
  spread.share_negative /= n;
  const auto at = quantiles<5>(stiffness, {0.05, 0.25, 0.5, 0.75, 0.95});
  spread.low = at[0];
  spread.quartile_low = at[1];
  spread.median = at[2];
  spread.quartile_high = at[3];
  spread.high = at[4];
  return spread;
}

}  // namespace stiffscope
