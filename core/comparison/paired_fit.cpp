#include "core/comparison/paired_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/estimate.h"
#include "core/identification/noise_share.h"
#include "core/identification/partial_pose.h"

namespace stiffscope::comparison {

namespace {

constexpr double kUnstated = std::numeric_limits<double>::quiet_NaN();
constexpr double kManyDegrees = 1e6;  // what is known exactly, as far as Student's t is concerned

}  // namespace

double Uncertain::expanded() const {
  if (stated) return *stated;
  if (!std::isfinite(sd) || !(dof > 0.0)) return kUnstated;
  return sd * identification::studentFactor(std::min(dof, kManyDegrees), identification::kStatedCoverage);
}

Uncertain PairedFit::combination(int joint, double weight_before, double weight_after) const {
  Uncertain result;
  result.value = weight_before * before[joint] + weight_after * after[joint];
  double scatter = 0.0, of_before = 0.0, of_after = 0.0;
  for (const auto& [first, second] : influences) {
    const double b = weight_before * first[joint], a = weight_after * second[joint];
    scatter += (b + a) * (b + a);
    of_before += b * b, of_after += a * a;
  }
  const double total = scatter + weight_before * weight_before * shared_before[joint] +
                       weight_after * weight_after * shared_after[joint];
  result.sd = std::isfinite(total) ? std::sqrt(total) : kUnstated;
  double dof = std::min(dof_before[joint], dof_after[joint]);
  if (!same_postures) {
    const double sum = of_before + of_after;
    dof = sum * sum / (of_before * of_before / dof_before[joint] + of_after * of_after / dof_after[joint]);
  }
  const double ratio = scatter > 0.0 ? total / scatter : std::numeric_limits<double>::infinity();
  result.dof = std::min(kManyDegrees, dof * ratio * ratio);
  return result;
}

Uncertain PairedFit::shareTaken(int joint) const {
  const double c_before = before[joint], c_after = after[joint];
  Uncertain share = combination(joint, c_after / (c_before * c_before), -1.0 / c_before);
  share.value = 1.0 - c_after / c_before;
  return share;
}

double PairedFit::correlation(int joint) const {
  double product = 0.0, of_before = 0.0, of_after = 0.0;
  for (const auto& [first, second] : influences) {
    product += first[joint] * second[joint];
    of_before += first[joint] * first[joint], of_after += second[joint] * second[joint];
  }
  const double scale = std::sqrt(of_before * of_after);
  return scale > 0.0 ? product / scale : 0.0;
}

namespace {

using identification::CaseEquations;
using identification::Identification;
using identification::Method;
using identification::StiffnessEstimate;

/// The equations of those load cases; empty where the method has not all of them.
std::vector<CaseEquations> ofCases(const std::vector<CaseEquations>& equations, const Identification& result,
                                   const std::vector<std::size_t>& cases) {
  if (equations.size() != result.cases.size()) return {};
  std::vector<CaseEquations> chosen;
  for (const std::size_t one : cases) chosen.push_back(equations[one]);
  return chosen;
}

/// A^T W A of those load cases by the tracker's noise; empty where it is not declared.
std::vector<JointMatrix> noiseOf(const campaign::Campaign& campaign, const Identification& result,
                                 const std::vector<CaseEquations>& equations, const std::vector<std::size_t>& cases) {
  if (!campaign.tracker) return {};
  identification::LoadedArm arm;
  arm.geometry = result.geometry;
  for (const std::size_t one : cases) arm.cases.push_back(result.cases[one]);
  return identification::reflectorNoise(*campaign.tracker, arm, equations);
}

/// The method's estimate from those load cases and joints, with its scatter alone.
StiffnessEstimate solvedFrom(const campaign::Campaign& campaign, const Identification& result, Method method,
                             const std::vector<std::size_t>& cases, const robot::JointMask& joints, double length) {
  const identification::MethodResult& own = result.of(method);
  const std::vector<CaseEquations> reflectors = ofCases(own.target_rows, result, cases);
  switch (method) {
    case Method::complete_pose:
      return identification::completePose(ofCases(own.pose_rows, result, cases), length, joints);
    case Method::decoupled_partial_pose:
      return identification::decoupledPartialPose(ofCases(own.wrist_rows, result, cases), reflectors, joints);
    case Method::partial_pose:
      break;
  }
  const std::vector<identification::NormalEquations> normal = identification::normalByPosture(reflectors);
  StiffnessEstimate estimate = identification::partialPose(reflectors, normal, joints);
  identification::correctForNoise(normal, noiseOf(campaign, result, reflectors, cases), estimate);
  return estimate;
}

/// Variances of what all postures of a state share.
JointVector sharedVariance(const StiffnessEstimate& estimate) {
  return (estimate.covariance - estimate.parts.scatter).diagonal().cwiseMax(0.0);
}

void setStates(const StiffnessEstimate& before, const StiffnessEstimate& after, PairedFit& fit) {
  fit.before = before.compliance, fit.after = after.compliance;
  fit.dof_before = before.scatter_dof, fit.dof_after = after.scatter_dof;
}

/// Influences of pairs side by side; of postures that the other state lacks, alone.
void pairInfluences(const StiffnessEstimate& before, const StiffnessEstimate& after,
                    const std::vector<PosturePair>& pairs, PairedFit& fit) {
  std::vector<bool> paired_before(before.influences.size()), paired_after(after.influences.size());
  for (const PosturePair& pair : pairs) {
    fit.influences.push_back({before.influences[pair.before], after.influences[pair.after]});
    paired_before[pair.before] = paired_after[pair.after] = true;
  }
  for (std::size_t p = 0; p < paired_before.size(); ++p) {
    if (!paired_before[p]) fit.influences.push_back({before.influences[p], JointVector::Zero(fit.before.size())});
  }
  for (std::size_t p = 0; p < paired_after.size(); ++p) {
    if (!paired_after[p]) fit.influences.push_back({JointVector::Zero(fit.before.size()), after.influences[p]});
  }
}

/// Whether the pairs are enough to leave the other postures out.
bool enough(const MatchedPostures& matched, const Identification& before, const Identification& after,
            std::size_t joints) {
  // 18 coordinates of a reflector for six joints; below it t soars.
  const std::size_t fewest = std::max<std::size_t>(6, joints);
  const std::size_t pairs = matched.pairs.size();
  return pairs >= fewest && 2 * pairs >= std::min(before.cases.size(), after.cases.size());
}

/// Whether a method has equations and influences of all load cases; its own geometry may leave one out.
bool hasEquations(const Identification& result, Method method) {
  const identification::MethodResult& own = result.of(method);
  const std::size_t cases = result.cases.size();
  return own.target_rows.size() == cases && own.estimate.influences.size() == cases &&
         (method != Method::decoupled_partial_pose || own.wrist_rows.size() == cases) &&
         (method != Method::complete_pose || own.pose_rows.size() == cases);
}

}  // namespace

PairedFit pairedFit(const campaign::Campaign& before_campaign, const Identification& before,
                    const campaign::Campaign& after_campaign, const Identification& after, Method method,
                    const MatchedPostures& matched) {
  PairedFit fit(before_campaign.robot.joints());
  if (!before.of(method).available || !after.of(method).available) return fit;
  const StiffnessEstimate &first = before.of(method).estimate, &second = after.of(method).estimate;
  for (std::size_t j = 0; j < fit.joints.size(); ++j) {
    fit.joints[j] = first.identifiable[j] && second.identifiable[j];
    fit.available = fit.available || fit.joints[j];
  }
  if (!fit.available) return fit;
  fit.shared_before = sharedVariance(first), fit.shared_after = sharedVariance(second);
  const bool paired = hasEquations(before, method) && hasEquations(after, method);
  fit.same_postures = paired && enough(matched, before, after, fit.joints.size());
  fit.postures = matched.pairs.size();
  StiffnessEstimate solved_before = first, solved_after = second;
  std::vector<PosturePair> pairs = paired ? matched.pairs : std::vector<PosturePair>{};
  if (fit.same_postures) {
    std::vector<std::size_t> cases_before, cases_after;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      cases_before.push_back(pairs[p].before), cases_after.push_back(pairs[p].after);
      pairs[p].before = pairs[p].after = p;
    }
    const double length = std::sqrt(before.characteristic_length.length * after.characteristic_length.length);
    solved_before = solvedFrom(before_campaign, before, method, cases_before, fit.joints, length);
    solved_after = solvedFrom(after_campaign, after, method, cases_after, fit.joints, length);
  }
  setStates(solved_before, solved_after, fit);
  pairInfluences(solved_before, solved_after, pairs, fit);
  if (!solved_before.covariance.allFinite() || !solved_after.covariance.allFinite()) {
    fit.dof_before.setZero(), fit.dof_after.setZero();
    fit.shared_before.setConstant(kUnstated), fit.shared_after.setConstant(kUnstated);
  }
  return fit;
}

std::vector<double> holm(const std::vector<double>& p_values) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p_values.size(); ++i) {
    if (std::isfinite(p_values[i])) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> corrected = p_values;
  double largest = 0.0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(order.size() - k) * p_values[order[k]]));
    corrected[order[k]] = largest;
  }
  return corrected;
}

}  // namespace stiffscope::comparison
