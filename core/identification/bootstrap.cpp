#include "core/identification/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

#include "core/identification/decoupled_partial_pose.h"

namespace stiffscope::identification {

namespace {

Vector6d solveDraw(const SubsetMethod& method, std::uint64_t seed, std::uint64_t draw) {
  std::seed_seq seeds{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                      static_cast<std::uint32_t>(draw)};
  std::mt19937_64 random(seeds);
  NormalEquations normal, reflectors;
  const std::size_t n = method.normal.size();
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t posture = random() % n;  // the bias of % is below 1e-17 here
    normal += method.normal[posture];
    if (!method.reflectors.empty()) reflectors += method.reflectors[posture];
  }
  return method.reflectors.empty() ? solveNormal(normal, method.unknown)
                                   : solveDecoupled(normal, reflectors, method.unknown);
}

/// By linear interpolation between order statistics.
double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

CoverageInterval PostureBootstrap::compliance(int joint, double coverage) const {
  if (compliances.empty()) return {};
  std::vector<double> sorted;
  for (const Vector6d& one : compliances) sorted.push_back(one[joint]);
  std::sort(sorted.begin(), sorted.end());
  return {quantile(sorted, 0.5 * (1.0 - coverage)), quantile(sorted, 0.5 * (1.0 + coverage))};
}

PostureBootstrap bootstrapPostures(const SubsetMethod& method, const PostureBootstrapOptions& options) {
  PostureBootstrap result;
  if (method.normal.empty() || options.draws <= 0) return result;
  result.compliances.resize(static_cast<std::size_t>(options.draws));
  const auto stride = static_cast<std::size_t>(std::max(1, options.threads));
  const auto work = [&](std::size_t first) {
    for (std::size_t draw = first; draw < result.compliances.size(); draw += stride) {
      result.compliances[draw] = solveDraw(method, options.seed, draw);
    }
  };
  std::vector<std::jthread> helpers;
  for (std::size_t first = 1; first < stride; ++first) helpers.emplace_back(work, first);
  work(0);
  helpers.clear();  // joins
  return result;
}

}  // namespace stiffscope::identification
