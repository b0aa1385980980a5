#include "core/comparison/compare.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identification/identification.h"
#include "core/identification/remarks.h"
#include "core/identification/shown_first.h"
#include "metrology/tail_probability.h"

namespace stiffscope::comparison {

identification::Method Comparison::best() const {
  return shown_first ? shown_first->method : identification::Method::complete_pose;
}

std::optional<identification::ShownFirst> comparedFirst(const identification::Identification& before,
                                                        const identification::Identification& after,
                                                        const std::array<StiffnessChange, 3>& methods) {
  std::array<bool, 3> usable{};
  std::transform(methods.begin(), methods.end(), usable.begin(),
                 [](const StiffnessChange& one) { return one.available; });
  const auto& first = before.shown_first;
  const bool papers = first && first->reason.is(identification::RemarkId::shown_as_in_the_paper);
  if (papers && usable[static_cast<std::size_t>(first->method)]) return first;
  const std::array<const identification::Identification*, 2> campaigns{&before, &after};
  return identification::methodShownFirst(campaigns, usable);
}

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
  const std::size_t pairs = result.matched.pairs.size(), all = pairs + result.matched.unmatched.size();
  const bool apart = std::any_of(result.methods.begin(), result.methods.end(),
                                 [](const StiffnessChange& one) { return one.available && !one.same_postures; });
  if (apart) {
    cautions.emplace_back(RemarkId::other_postures, pairs);
  } else if (pairs > 0 && 2 * pairs < all) {
    cautions.emplace_back(RemarkId::few_correspond, pairs, all);
  }
  const CommonResidual& left = result.residual;
  if (left.differenceAboveNoise()) {
    cautions.emplace_back(RemarkId::difference_above_noise, left.of_difference,
                          std::hypot(*left.noise_before, *left.noise_after));
  }
  return cautions;
}

/// What identification itself cautions of, which ratios and p-values inherit.
void addWarnings(When when, const identification::Identification& one, std::vector<Remark>& cautions) {
  for (const auto& caution : one.cautions) cautions.emplace_back(RemarkId::of_one_campaign, when, caution);
}

double avoidedRest(const StiffnessChange& change, const DeflectionAvoided& at_targets) {
  if (!change.available || !at_targets.available) return std::numeric_limits<double>::quiet_NaN();
  double rest = at_targets.share;
  for (const JointChange& joint : change.joints) {
    if (joint.comparable) rest -= joint.avoided.value;
  }
  return rest;
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
    result.methods[static_cast<std::size_t>(method)] =
        compareStiffness(before_campaign, before, after_campaign, after, method, result.matched);
  }
  result.shown_first = comparedFirst(before, after, result.methods);
  result.residual = commonResidual(before_campaign, before, after_campaign, after, result.matched);
  result.at_wrist = deflectionAvoidedAtWrist(before, after, result.matched, options);
  result.at_targets = deflectionAvoidedAtTargets(before, after, result.matched, options);
  for (StiffnessChange& change : result.methods) change.avoided_rest = avoidedRest(change, result.at_targets);
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

Remark markOf(const identification::StiffnessEstimate& before, const identification::StiffnessEstimate& after,
              int joint) {
  Remark first = before.mark(joint), second = after.mark(joint);
  return first.is(identification::RemarkId::negative) || second.empty() ? first : second;
}

/// Two-sided, of a number that is zero.
double pOfZero(const Uncertain& number, double size) {
  constexpr double kRounding = 1e-12;  // of the size: what is left of equal ones
  if (!std::isfinite(number.sd) || !(number.dof > 0.0)) return kNone;
  if (number.sd <= kRounding * size) return std::abs(number.value) <= kRounding * size ? 1.0 : kNone;
  const double t = number.value / number.sd;
  return metrology::fTail(t * t, 1, number.dof);
}

/// The stiffnesses of each campaign's own identification.
void stateStiffnesses(const identification::StiffnessEstimate& before, const identification::StiffnessEstimate& after,
                      int joint, JointChange& change) {
  change.before = {before.stiffness(joint), before.stiffnessSd(joint), before.dof(joint)};
  change.after = {after.stiffness(joint), after.stiffnessSd(joint), after.dof(joint)};
  change.ratio.value = before.compliance[joint] / after.compliance[joint];
  change.mark = markOf(before, after, joint);
}

void judge(const PairedFit& fit, int joint, double avoided_by_unit, JointChange& change) {
  change.comparable = true;
  change.difference = fit.difference(joint);
  change.correlation = fit.correlation(joint);
  change.p_value = pOfZero(change.difference, std::abs(fit.before[joint]));
  change.taken = fit.shareTaken(joint);
  change.ratio.sd = change.ratio.value * change.ratio.value * change.taken.sd;  // r = 1 / (1 - share)
  change.ratio.dof = change.taken.dof;
  const Uncertain before = fit.combination(joint, 1.0, 0.0);
  if (!(before.value > before.expanded())) change.taken.value = change.taken.sd = kNone;
  change.avoided = {-avoided_by_unit * change.difference.value, std::abs(avoided_by_unit) * change.difference.sd,
                    change.difference.dof};
  if (avoided_by_unit == 0.0) change.avoided.value = change.avoided.sd = kNone;
}

/// The side that is held: as the encoders show, else as the campaign declares.
identification::HeldSide heldSide(const campaign::Campaign& campaign, const identification::Identification& one,
                                  std::size_t joint) {
  if (one.transmission && one.transmission->joints[joint].measured) return one.transmission->joints[joint].held;
  switch (campaign.double_encoder) {
    case campaign::DoubleEncoder::active:
      return identification::HeldSide::link;
    case campaign::DoubleEncoder::inactive:
      return identification::HeldSide::motor;
    case campaign::DoubleEncoder::unspecified:
      break;
  }
  return identification::HeldSide::unknown;
}

/// The joint's gear by its encoders; of the two campaigns that which has it with the smaller uncertainty.
std::optional<Uncertain> gearOf(const identification::Identification& before,
                                const identification::Identification& after, int joint) {
  std::optional<Uncertain> best;
  for (const identification::Identification* one : {&before, &after}) {
    if (!one->transmission || !one->transmission->joints[static_cast<std::size_t>(joint)].measured) continue;
    const identification::StiffnessEstimate& gears = one->transmission->estimate;
    const Uncertain own{gears.compliance[joint], std::sqrt(gears.covariance(joint, joint)), gears.dof(joint)};
    if (!best || own.sd < best->sd) best = own;
  }
  return best;
}

GearCheck checkOf(const Uncertain& gear, const Uncertain& difference) {
  const double a = gear.sd * gear.sd, b = difference.sd * difference.sd;
  // Welch and Satterthwaite.
  const Uncertain apart{-difference.value - gear.value, std::sqrt(a + b),
                        (a + b) * (a + b) / (a * a / gear.dof + b * b / difference.dof)};
  return {gear, pOfZero(apart, std::abs(gear.value))};
}

void correctForJoints(std::array<JointChange, 6>& joints) {
  std::vector<double> p_values;
  for (const JointChange& joint : joints) p_values.push_back(joint.comparable ? joint.p_value : kNone);
  const std::vector<double> corrected = holm(p_values);
  for (std::size_t j = 0; j < 6; ++j) joints[j].p_holm = corrected[j];
}

}  // namespace

StiffnessChange compareStiffness(const campaign::Campaign& before_campaign,
                                 const identification::Identification& before, const campaign::Campaign& after_campaign,
                                 const identification::Identification& after, identification::Method method,
                                 const MatchedPostures& matched) {
  const identification::MethodResult &first = before.of(method), &second = after.of(method);
  StiffnessChange result;
  if (!first.available || !second.available) {
    result.reason = !first.available ? Remark(RemarkId::of_one_campaign, When::before, first.reason)
                                     : Remark(RemarkId::of_one_campaign, When::after, second.reason);
    return result;
  }
  const PairedFit fit = pairedFit(before_campaign, before, after_campaign, after, method, matched);
  result.available = fit.available;
  result.same_postures = fit.same_postures, result.postures = fit.postures;
  const Vector6d by_unit = fit.available
                               ? avoidedByUnit(before_campaign, before, after_campaign, after, method, matched)
                               : Vector6d(Vector6d::Zero());
  for (std::size_t j = 0; j < 6; ++j) {
    JointChange& change = result.joints[j];
    if (!fit.joints[j]) {
      const bool seen_before = first.estimate.identifiable[j], seen_after = second.estimate.identifiable[j];
      const identification::Identifiability& blind = seen_before ? after.identifiability : before.identifiability;
      const When when = seen_before ? When::after : (seen_after ? When::before : When::both);
      change.reason = Remark(RemarkId::not_identifiable, when, blind.joints[j].reason);
      continue;
    }
    const int joint = static_cast<int>(j);
    stateStiffnesses(first.estimate, second.estimate, joint, change);
    judge(fit, joint, by_unit[joint], change);
    const bool taken_away = heldSide(before_campaign, before, j) == identification::HeldSide::motor &&
                            heldSide(after_campaign, after, j) == identification::HeldSide::link;
    if (const auto gear = gearOf(before, after, joint); gear && taken_away) {
      change.gear = checkOf(*gear, change.difference);
    }
  }
  correctForJoints(result.joints);
  if (!result.available) result.reason = Remark(RemarkId::no_joint_in_both);
  return result;
}

}  // namespace stiffscope::comparison
