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
  const numerics::BootstrapSpread spread = numerics::bootstrapSpread(std::move(shares), static_cast<double>(n));
  result.low = result.share - spread.below;
  result.high = result.share + spread.above;
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

JointVector avoidedByUnit(const campaign::Campaign& before_campaign, const identification::Identification& before,
                          const campaign::Campaign& after_campaign, const identification::Identification& after,
                          identification::Method method, const MatchedPostures& matched) {
  const auto &rows_before = before.of(method).target_rows, &rows_after = after.of(method).target_rows;
  JointVector sum = JointVector::Zero(before_campaign.robot.joints());
  if (rows_before.size() != before.cases.size() || rows_after.size() != after.cases.size()) return sum;
  double whole = 0.0;
  for (const PosturePair& pair : matched.pairs) {
    const identification::LoadCase &first = before.cases[pair.before], &second = after.cases[pair.after];
    const std::vector<ReflectorPair> reflectors = reflectorsInBoth(before_campaign, first, after_campaign, second);
    JointVector own = JointVector::Zero(sum.size());
    for (const ReflectorPair& one : reflectors) {
      const Eigen::Vector3d d_before = first.targets[one.before].displacement(),
                            d_after = second.targets[one.after].displacement();
      const double lengths = d_before.norm() + d_after.norm();
      if (!(lengths > 0.0)) continue;
      const auto row_before = static_cast<Eigen::Index>(3 * one.before),
                 row_after = static_cast<Eigen::Index>(3 * one.after);
      const PointJacobian mean = 0.5 * (rows_before[pair.before].matrix.middleRows<3>(row_before) +
                                        rows_after[pair.after].matrix.middleRows<3>(row_after));
      own += mean.transpose() * (d_before + d_after) / lengths;
    }
    if (!reflectors.empty()) sum += own / static_cast<double>(reflectors.size());
    whole += before.target_displacement[pair.before];
  }
  return whole > 0.0 ? JointVector(sum / whole) : JointVector(JointVector::Zero(sum.size()));
}

}  // namespace stiffscope::comparison
