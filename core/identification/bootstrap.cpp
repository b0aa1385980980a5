#include "core/identification/subsets.h"

#include <algorithm>
#include <random>

#include "core/numerics/parallel.h"
#include "core/numerics/resampling.h"

namespace stiffscope::identification {

namespace {

JointVector solveDraw(const SubsetMethod& method, std::uint64_t seed, std::uint64_t draw) {
  std::seed_seq seeds{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                      static_cast<std::uint32_t>(draw)};
  std::mt19937_64 random(seeds);
  NormalEquations normal, reflectors;
  numerics::drawWithReplacement(random, method.normal.size(), [&](std::size_t posture) {
    normal += method.normal[posture];
    if (!method.reflectors.empty()) reflectors += method.reflectors[posture];
  });
  return solveSubset(method, normal, reflectors);
}

}  // namespace

CoverageInterval PostureBootstrap::compliance(int joint, double coverage) const {
  if (compliances.empty()) return {};
  std::vector<double> sorted;
  for (const JointVector& one : compliances) sorted.push_back(one[joint]);
  std::sort(sorted.begin(), sorted.end());
  return {numerics::quantile(sorted, 0.5 * (1.0 - coverage)), numerics::quantile(sorted, 0.5 * (1.0 + coverage))};
}

PostureBootstrap bootstrapPostures(const SubsetMethod& method, const PostureBootstrapOptions& options) {
  PostureBootstrap result;
  if (method.normal.empty() || options.draws <= 0) return result;
  result.compliances.resize(static_cast<std::size_t>(options.draws));
  numerics::onAllCores(result.compliances.size(),
                       [&](std::size_t draw) { result.compliances[draw] = solveDraw(method, options.seed, draw); });
  return result;
}

}  // namespace stiffscope::identification
