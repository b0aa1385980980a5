#include "core/comparison/compare.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identification/identification.h"
#include "core/identification/remarks.h"
#include "core/identification/subsets.h"
#include "metrology/tail_probability.h"

namespace stiffscope::comparison {

identification::Method Comparison::best() const { return identification::bestMethod(*this); }

namespace {

std::vector<Remark> warningsOf(const campaign::Campaign& before_campaign, const campaign::Campaign& after_campaign,
                               const Comparison& result) {
  std::vector<Remark> cautions = doubtsOfOneMachine(before_campaign.robot, after_campaign.robot);
  if (before_campaign.double_encoder == after_campaign.double_encoder &&
      before_campaign.double_encoder != campaign::DoubleEncoder::unspecified) {
    cautions.emplace_back(RemarkId::same_encoders, before_campaign.double_encoder == campaign::DoubleEncoder::active);
  }
  if (before_campaign.double_encoder == campaign::DoubleEncoder::active &&
      after_campaign.double_encoder == campaign::DoubleEncoder::inactive) {
    cautions.emplace_back(RemarkId::encoders_swapped);
  }
  const std::size_t all = result.matched.pairs.size() + result.matched.unmatched.size();
  if (!result.matched.pairs.empty() && 2 * result.matched.pairs.size() < all) {
    cautions.emplace_back(RemarkId::few_correspond, result.matched.pairs.size(), all);
  }
  return cautions;
}

/// What identification itself cautions of, which ratios and p-values inherit.
void addWarnings(When when, const identification::Identification& one, std::vector<Remark>& cautions) {
  for (const auto& caution : one.cautions) cautions.emplace_back(RemarkId::of_one_campaign, when, caution);
}

}  // namespace

Comparison compareCampaigns(const campaign::Campaign& before_campaign, const identification::Identification& before,
                            const campaign::Campaign& after_campaign, const identification::Identification& after,
                            const BootstrapOptions& options) {
  Comparison result;
  result.reason = differenceOfMachines(before_campaign.robot, after_campaign.robot);
  if (!result.reason.empty()) {
    for (StiffnessChange& method : result.methods) method.reason = result.reason;
    result.at_wrist.reason = result.at_targets.reason = result.reason;
    return result;
  }
  result.matched = matchPostures(before_campaign, before, after_campaign, after);
  for (const identification::Method method : identification::kMethods) {
    result.methods[static_cast<std::size_t>(method)] = compareStiffness(before, after, method, result.matched);
  }
  result.at_wrist = deflectionAvoidedAtWrist(before, after, result.matched, options);
  result.at_targets = deflectionAvoidedAtTargets(before, after, result.matched, options);
  result.comparable =
      result.avoided().available || std::any_of(result.methods.begin(), result.methods.end(),
                                                [](const StiffnessChange& one) { return one.available; });
  if (!result.comparable) {
    result.reason = Remark(RemarkId::nothing_comparable, result.at_targets.reason, result.of(result.best()).reason);
  }
  result.cautions = warningsOf(before_campaign, after_campaign, result);
  addWarnings(When::before, before, result.cautions);
  addWarnings(When::after, after, result.cautions);
  return result;
}

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double degreesOfFreedom(std::size_t postures, const robot::JointMask& unknown) {
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

Remark markOf(const identification::StiffnessEstimate& before, const identification::StiffnessEstimate& after,
              int joint) {
  Remark first = before.mark(joint), second = after.mark(joint);
  return first.is(identification::RemarkId::negative) || second.empty() ? first : second;
}

void judge(const identification::StiffnessEstimate& before, const identification::StiffnessEstimate& after, int joint,
           double degrees, JointChange& change) {
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
    change.p_value = metrology::fTail(difference * difference / variance, 1, degrees);
  }
}

}  // namespace

StiffnessChange compareStiffness(const identification::Identification& before,
                                 const identification::Identification& after, identification::Method method,
                                 const MatchedPostures& matched) {
  const identification::MethodResult &first = before.of(method), &second = after.of(method);
  StiffnessChange result;
  if (!first.available || !second.available) {
    result.reason = !first.available ? Remark(RemarkId::of_one_campaign, When::before, first.reason)
                                     : Remark(RemarkId::of_one_campaign, When::after, second.reason);
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
      const identification::Identifiability& blind = seen_before ? after.identifiability : before.identifiability;
      const When when = seen_before ? When::after : (seen_after ? When::before : When::both);
      change.reason = Remark(RemarkId::not_identifiable, when, blind.joints[j].reason);
      continue;
    }
    change.correlation = correlation[static_cast<Eigen::Index>(j)];
    judge(first.estimate, second.estimate, static_cast<int>(j), degrees, change);
    result.available = true;
  }
  if (!result.available) result.reason = Remark(RemarkId::no_joint_in_both);
  return result;
}

namespace {

using Normals = std::vector<identification::NormalEquations>;

Normals normalOf(const std::vector<identification::CaseEquations>& equations) {
  Normals normal;
  for (const identification::CaseEquations& one : equations) normal.push_back(identification::normalEquations(one));
  return normal;
}

/// Complete Pose's equations, which its result does not keep, from the load cases.
Normals completePoseNormals(const identification::Identification& result) {
  const identification::MethodResult& method = result.of(identification::Method::complete_pose);
  const auto torques = result.finite_deflection ? identification::jointTorquesWithGeometricStiffness(
                                                      method.geometry, result.cases, method.estimate.compliance)
                                                : identification::jointTorques(result.cases);
  Normals normal;
  for (std::size_t i = 0; i < result.cases.size(); ++i) {
    const identification::CaseEquations pose =
        identification::completePoseEquations(result.cases[i], result.frames.tcp_in_flange, torques[i]);
    normal.push_back(
        identification::normalEquations(identification::normalised(pose, result.characteristic_length.length)));
  }
  return normal;
}

identification::NormalEquations without(const identification::NormalEquations& sum,
                                        const identification::NormalEquations& one) {
  return {sum.matrix - one.matrix, sum.right - one.right};
}

/// Of all postures less that of the others, a posture each.
std::vector<Vector6d> movesOf(const identification::SubsetMethod& method) {
  const bool decoupled = !method.reflectors.empty();
  const identification::NormalEquations sum = identification::sumOf(method.normal);
  const identification::NormalEquations reflectors =
      decoupled ? identification::sumOf(method.reflectors) : identification::NormalEquations{};
  const Vector6d all = identification::solveSubset(method, sum, reflectors);
  std::vector<Vector6d> moves;
  for (std::size_t p = 0; p < method.normal.size(); ++p) {
    moves.push_back(all -
                    identification::solveSubset(method, without(sum, method.normal[p]),
                                                decoupled ? without(reflectors, method.reflectors[p]) : reflectors));
  }
  return moves;
}

}  // namespace

std::vector<Vector6d> moveByEachPosture(const identification::Identification& result, identification::Method method) {
  const identification::MethodResult& solved = result.of(method);
  if (!solved.available) return {};
  identification::SubsetMethod equations;
  equations.unknown = solved.estimate.identifiable;
  switch (method) {
    case identification::Method::complete_pose:
      equations.normal = completePoseNormals(result);
      break;
    case identification::Method::partial_pose:
      equations.normal = normalOf(solved.target_rows);
      break;
    case identification::Method::decoupled_partial_pose:
      equations.normal = normalOf(solved.wrist_rows);
      equations.reflectors = normalOf(solved.target_rows);
      break;
  }
  return movesOf(equations);
}

}  // namespace stiffscope::comparison
