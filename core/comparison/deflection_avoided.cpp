#include "core/comparison/deflection_avoided.h"

#include <algorithm>
#include <limits>
#include <random>

namespace stiffscope::comparison {

namespace {

DeflectionAvoided ofPairs(const std::vector<double>& before, const std::vector<double>& after,
                          const MatchedPostures& matched, const BootstrapOptions& options) {
  if (matched.pairs.empty()) {
    DeflectionAvoided none;
    none.reason = "no posture was measured in both campaigns with the same joint angles and load";
    return none;
  }
  std::vector<PostureDeflection> postures;
  for (const PosturePair& pair : matched.pairs)
    postures.push_back({pair.pose, before[pair.before], after[pair.after]});
  return shareAvoided(std::move(postures), options);
}

/// Value below which `share` of the sorted values lie, linear between neighbours.
double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

DeflectionAvoided shareAvoided(std::vector<PostureDeflection> postures, const BootstrapOptions& options) {
  DeflectionAvoided result;
  double before = 0.0, after = 0.0;
  for (const PostureDeflection& one : postures) before += one.before, after += one.after;
  result.postures = std::move(postures);
  result.low = result.high = std::numeric_limits<double>::quiet_NaN();
  if (!(before > 0.0)) {
    result.reason = "nothing moved before: there is no deflection to avoid";
    return result;
  }
  result.available = true;
  result.share = 1.0 - after / before;
  constexpr std::size_t kFewest = 5;  // below it too few different samples exist for a 2.5 % quantile
  const std::size_t n = result.postures.size();
  if (n < kFewest || options.samples < 1) return result;
  std::mt19937_64 random(options.seed);
  std::vector<double> shares;
  for (int sample = 0; sample < options.samples; ++sample) {
    double sum_before = 0.0, sum_after = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      const PostureDeflection& one = result.postures[random() % n];  // the bias of % is below 1e-15 here
      sum_before += one.before, sum_after += one.after;
    }
    if (sum_before > 0.0) shares.push_back(1.0 - sum_after / sum_before);
  }
  std::sort(shares.begin(), shares.end());
  result.low = quantile(shares, 0.025);
  result.high = quantile(shares, 0.975);
  return result;
}

DeflectionAvoided deflectionAvoidedAtWrist(const identification::Identification& before, const identification::Identification& after,
                                           const MatchedPostures& matched, const BootstrapOptions& options) {
  if (before.wrist_displacement.empty() || after.wrist_displacement.empty()) {
    DeflectionAvoided none;
    none.reason =
        std::string("P_wrist is not measured ") + (before.wrist_displacement.empty() ? "before" : "after");
    return none;
  }
  return ofPairs(before.wrist_displacement, after.wrist_displacement, matched, options);
}

DeflectionAvoided deflectionAvoidedAtTargets(const identification::Identification& before, const identification::Identification& after,
                                             const MatchedPostures& matched,
                                             const BootstrapOptions& options) {
  return ofPairs(before.target_displacement, after.target_displacement, matched, options);
}

}  // namespace stiffscope::comparison
