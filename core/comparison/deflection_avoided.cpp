#include "core/comparison/deflection_avoided.h"

#include <algorithm>
#include <limits>
#include <random>

#include "core/numerics/resampling.h"

namespace stiffscope::comparison {

namespace {

DeflectionAvoided ofPairs(const std::vector<double>& before, const std::vector<double>& after,
                          const MatchedPostures& matched, const BootstrapOptions& options) {
  if (matched.pairs.empty()) {
    DeflectionAvoided none;
    none.reason = Remark(RemarkId::no_posture_in_both);
    return none;
  }
  std::vector<PostureDeflection> postures;
  for (const PosturePair& pair : matched.pairs) postures.push_back({pair.pose, before[pair.before], after[pair.after]});
  return shareAvoided(std::move(postures), options);
}

}  // namespace

DeflectionAvoided shareAvoided(std::vector<PostureDeflection> postures, const BootstrapOptions& options) {
  DeflectionAvoided result;
  double before = 0.0, after = 0.0;
  for (const PostureDeflection& one : postures) before += one.before, after += one.after;
  result.postures = std::move(postures);
  result.low = result.high = std::numeric_limits<double>::quiet_NaN();
  if (!(before > 0.0)) {
    result.reason = Remark(RemarkId::nothing_moved_before);
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
    numerics::drawWithReplacement(random, n, [&](std::size_t posture) {
      const PostureDeflection& one = result.postures[posture];
      sum_before += one.before, sum_after += one.after;
    });
    if (sum_before > 0.0) shares.push_back(1.0 - sum_after / sum_before);
  }
  std::sort(shares.begin(), shares.end());
  result.low = numerics::quantile(shares, 0.025);
  result.high = numerics::quantile(shares, 0.975);
  return result;
}

DeflectionAvoided deflectionAvoidedAtWrist(const identification::Identification& before,
                                           const identification::Identification& after, const MatchedPostures& matched,
                                           const BootstrapOptions& options) {
  if (before.wrist_displacement.empty() || after.wrist_displacement.empty()) {
    DeflectionAvoided none;
    none.reason = Remark(RemarkId::wrist_not_measured, before.wrist_displacement.empty() ? When::before : When::after);
    return none;
  }
  return ofPairs(before.wrist_displacement, after.wrist_displacement, matched, options);
}

DeflectionAvoided deflectionAvoidedAtTargets(const identification::Identification& before,
                                             const identification::Identification& after,
                                             const MatchedPostures& matched, const BootstrapOptions& options) {
  return ofPairs(before.target_displacement, after.target_displacement, matched, options);
}

}  // namespace stiffscope::comparison
