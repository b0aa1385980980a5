#include "core/comparison/compare_stiffness.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/comparison/without_each_posture.h"
#include "metrology/tail_probability.h"

namespace stiffscope {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double degreesOfFreedom(std::size_t postures, const JointMask& unknown) {
  const auto unknowns = static_cast<double>(std::count(unknown.begin(), unknown.end(), true));
  return static_cast<double>(postures) - unknowns / 3.0;
}

/// Correlation of the two campaigns' errors of each compliance.
Vector6d correlations(const std::vector<Vector6d>& before, const std::vector<Vector6d>& after,
                      const std::vector<PosturePair>& pairs) {
  Vector6d shared = Vector6d::Zero(), own_before = Vector6d::Zero(), own_after = Vector6d::Zero();
  for (const Vector6d& one : before) own_before += one.cwiseAbs2();
  for (const Vector6d& one : after) own_after += one.cwiseAbs2();
  for (const PosturePair& pair : pairs) {
    if (pair.before < before.size() && pair.after < after.size()) {
      shared += before[pair.before].cwiseProduct(after[pair.after]);
    }
  }
  Vector6d result = Vector6d::Zero();
  for (int j = 0; j < 6; ++j) {
    const double scale = std::sqrt(own_before[j] * own_after[j]);
    if (scale > 0.0) result[j] = shared[j] / scale;
  }
  return result;
}

std::string markOf(const StiffnessEstimate& before, const StiffnessEstimate& after, int joint) {
  const std::string first = before.mark(joint), second = after.mark(joint);
  return first == "negative" || second.empty() ? first : second;
}

void judge(const StiffnessEstimate& before, const StiffnessEstimate& after, int joint, double degrees,
           JointChange& change) {
  const double c_before = before.compliance[joint], c_after = after.compliance[joint];
  const double u_before = std::sqrt(before.covariance(joint, joint)),
               u_after = std::sqrt(after.covariance(joint, joint));
  change.comparable = true;
  change.before = before.stiffness(joint), change.before_sd = before.stiffnessSd(joint);
  change.after = after.stiffness(joint), change.after_sd = after.stiffnessSd(joint);
  change.ratio = c_before / c_after;
  const double r = change.correlation, a = u_before / c_before, b = u_after / c_after;
  change.ratio_sd = std::abs(change.ratio) * std::sqrt(std::max(0.0, a * a + b * b - 2.0 * r * a * b));
  change.mark = markOf(before, after, joint);
  const double difference = c_after - c_before;
  const double variance = u_before * u_before + u_after * u_after - 2.0 * r * u_before * u_after;
  constexpr double kRounding = 1e-12;  // of the variances: what is left of equal ones
  if (!(degrees > 0.0) || !std::isfinite(variance)) {
    change.p_value = kNone;
  } else if (variance <= kRounding * (u_before * u_before + u_after * u_after)) {
    change.p_value = std::abs(difference) <= kRounding * std::abs(c_before) ? 1.0 : kNone;
  } else {
    change.p_value = fTail(difference * difference / variance, 1, degrees);
  }
}

}  // namespace

StiffnessChange compareStiffness(const Identification& before, const Identification& after, Method method,
                                 const MatchedPostures& matched) {
  const MethodResult &first = before.of(method), &second = after.of(method);
  StiffnessChange result;
  if (!first.available || !second.available) {
    result.reason = !first.available ? "before: " + first.reason : "after: " + second.reason;
    return result;
  }
  const std::vector<Vector6d> moves_before = moveByEachPosture(before, method);
  const std::vector<Vector6d> moves_after = moveByEachPosture(after, method);
  const Vector6d correlation = correlations(moves_before, moves_after, matched.pairs);
  const double degrees = std::min(degreesOfFreedom(moves_before.size(), first.estimate.identifiable),
                                  degreesOfFreedom(moves_after.size(), second.estimate.identifiable));
  for (std::size_t j = 0; j < 6; ++j) {
    JointChange& change = result.joints[j];
    const bool seen_before = first.estimate.identifiable[j], seen_after = second.estimate.identifiable[j];
    if (!seen_before || !seen_after) {
      const Identifiability& blind = seen_before ? after.identifiability : before.identifiability;
      change.reason = fmt::format("not identifiable {}: {}",
                                  seen_before ? "after" : (seen_after ? "before" : "in either campaign"),
                                  blind.joints[j].reason);
      continue;
    }
    change.correlation = correlation[static_cast<Eigen::Index>(j)];
    judge(first.estimate, second.estimate, static_cast<int>(j), degrees, change);
    result.available = true;
  }
  if (!result.available) result.reason = "no joint is identifiable in both campaigns";
  return result;
}

}  // namespace stiffscope
