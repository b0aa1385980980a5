#include "core/comparison/compare.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/comparison/stated_change.h"
#include "core/identification/identification.h"
#include "core/identification/remarks.h"
#include "core/identification/shown_first.h"

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
  const bool apart = std::any_of(result.methods.begin(), result.methods.end(), [](const StiffnessChange& one) {
    return one.available && !one.same_postures && !one.by_models;
  });
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
                            const SupportedModels& models, const BootstrapOptions& options) {
  Comparison result;
  result.reason = differenceOfMachines(before_campaign.robot, after_campaign.robot);
  if (!result.reason.empty()) {
    for (StiffnessChange& method : result.methods) {
      method.reason = result.reason;
      method.joints.resize(static_cast<std::size_t>(before_campaign.robot.joints()));
    }
    result.at_wrist.reason = result.at_targets.reason = result.reason;
    return result;
  }
  result.matched = matchPostures(before_campaign, before, after_campaign, after);
  for (const identification::Method method : identification::kMethods) {
    result.methods[static_cast<std::size_t>(method)] =
        compareStiffness(before_campaign, before, after_campaign, after, method, result.matched, models);
  }
  result.shown_first = comparedFirst(before, after, result.methods);
  result.models_hold = models.given() && models.effects && models.explained;
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
  addWarnings(When::before, models.given() ? *models.before : before, result.cautions);
  addWarnings(When::after, models.given() ? *models.after : after, result.cautions);
  return result;
}

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Remark markOf(const identification::StiffnessEstimate& before, const identification::StiffnessEstimate& after,
              int joint) {
  Remark first = before.mark(joint), second = after.mark(joint);
  return first.is(identification::RemarkId::negative) || second.empty() ? first : second;
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
  return identification::declaredSide(campaign.doubleEncoderOf(static_cast<int>(joint)));
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

/// k of the two models, and where effects are in them the ratio, their errors as independent, and the share taken.
void stateModels(const identification::StiffnessEstimate& before, const identification::StiffnessEstimate& after,
                 bool effects, int joint, JointChange& change) {
  const auto stated = [&](const identification::StiffnessEstimate& one) {
    return Uncertain{one.stiffness(joint), one.stiffnessSd(joint), one.dof(joint),
                     identification::expandedUncertainty(one, joint)};
  };
  change.before = stated(before), change.after = stated(after);
  change.mark = markOf(before, after, joint);
  if (!effects) return;
  const auto relative = [](const Uncertain& k) { return k.sd / k.value; };
  const auto relative_u = [](const Uncertain& k) { return k.expanded() / k.value; };
  change.ratio.value = change.after.value / change.before.value;
  change.ratio.sd = std::abs(change.ratio.value) * std::hypot(relative(change.before), relative(change.after));
  change.ratio.dof = std::min(change.before.dof, change.after.dof);
  // The difference is free of bias, and so is the model's compliance before.
  const double c_before = before.compliance[joint], d = change.difference.value;
  const identification::CoverageInterval interval = identification::complianceInterval(before, joint);
  const double u_before = std::max(interval.high - c_before, c_before - interval.low);
  const double u = std::hypot(change.difference.expanded() / c_before, d * u_before / (c_before * c_before));
  change.taken = {-d / c_before, u / identification::kNormalFactor, change.difference.dof, u};
  if (!(c_before > u_before)) change.taken = {kNone, kNone, 0.0};
  change.ratio.stated = std::abs(change.ratio.value) * std::hypot(relative_u(change.before), relative_u(change.after));
}

/// The difference of the two models' compliances with U from their intervals, and what follows of it.
void differByModels(const identification::StiffnessEstimate& before, const identification::StiffnessEstimate& after,
                    int joint, double avoided_by_unit, JointChange& change) {
  const identification::CoverageInterval interval_before = identification::complianceInterval(before, joint),
                                         interval_after = identification::complianceInterval(after, joint);
  const double c_before = before.compliance[joint], c_after = after.compliance[joint];
  const double u_before = fartherEnd(c_before, interval_before), u_after = fartherEnd(c_after, interval_after);
  change.difference = differenceOfStated(c_before, interval_before, c_after, interval_after);
  change.correlation = 0.0;
  change.p_value = pOfZero(change.difference, std::abs(c_before));
  const double taken_u = std::hypot(u_after / c_before, c_after * u_before / (c_before * c_before));
  change.taken = {1.0 - c_after / c_before, taken_u / identification::kNormalFactor, change.difference.dof, taken_u};
  if (!(c_before > u_before)) change.taken = {kNone, kNone, 0.0};
  const double by_unit = std::abs(avoided_by_unit);
  change.avoided = {-avoided_by_unit * change.difference.value, by_unit * change.difference.sd, change.difference.dof,
                    by_unit * change.difference.expanded()};
  if (avoided_by_unit == 0.0) change.avoided = {kNone, kNone, 0.0};
}

void correctForJoints(PerJoint<JointChange>& joints) {
  std::vector<double> p_values;
  for (const JointChange& joint : joints) p_values.push_back(joint.comparable ? joint.p_value : kNone);
  const std::vector<double> corrected = holm(p_values);
  for (std::size_t j = 0; j < joints.size(); ++j) joints[j].p_holm = corrected[j];
}

}  // namespace

StiffnessChange compareStiffness(const campaign::Campaign& before_campaign,
                                 const identification::Identification& before, const campaign::Campaign& after_campaign,
                                 const identification::Identification& after, identification::Method method,
                                 const MatchedPostures& matched, const SupportedModels& models) {
  const identification::MethodResult &first = before.of(method), &second = after.of(method);
  StiffnessChange result;
  result.joints.resize(static_cast<std::size_t>(before_campaign.robot.joints()));
  if (!first.available || !second.available) {
    result.reason = !first.available ? Remark(RemarkId::of_one_campaign, When::before, first.reason)
                                     : Remark(RemarkId::of_one_campaign, When::after, second.reason);
    return result;
  }
  const PairedFit fit = pairedFit(before_campaign, before, after_campaign, after, method, matched);
  result.available = fit.available;
  result.same_postures = fit.same_postures, result.postures = fit.postures;
  const JointVector by_unit = fit.available
                                  ? avoidedByUnit(before_campaign, before, after_campaign, after, method, matched)
                                  : JointVector(JointVector::Zero(before_campaign.robot.joints()));
  const bool modelled = models.given() && models.before->of(method).available && models.after->of(method).available;
  result.by_models = modelled && result.available && !result.same_postures;
  for (std::size_t j = 0; j < result.joints.size(); ++j) {
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
    if (modelled) {
      const identification::StiffnessEstimate& model_before = models.before->of(method).estimate;
      const identification::StiffnessEstimate& model_after = models.after->of(method).estimate;
      if (model_before.identifiable[j] && model_after.identifiable[j]) {
        stateModels(model_before, model_after, models.effects, joint, change);
        if (result.by_models) differByModels(model_before, model_after, joint, by_unit[joint], change);
      }
    }
    // Held against the difference that is stated, whichever of the two it is.
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
