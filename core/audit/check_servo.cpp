#include <algorithm>
#include <cmath>

#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/rows.h"
#include "core/input/units.h"

namespace stiffscope {

namespace {

/// Largest distance of a reflector from any joint axis over the load cases: how far a turn carries it per
/// radian.
double longestLever(const LoadedArm& arm) {
  double longest = 0.0;
  for (const LoadCase& load_case : arm.cases) {
    for (const TargetMove& move : load_case.targets) {
      const Matrix6d jacobian = jacobianAt(load_case.axes, move.unloaded);
      longest = std::max(longest, jacobian.topRows<3>().colwise().norm().maxCoeff());
    }
  }
  return longest;
}

/// One-sigma noise of one reading of a reflector, per coordinate, m: the largest of all states.
double readingNoise(const Evidence& evidence) {
  double variance = evidence.noise->covarianceAt(evidence.noise->station).trace() / 3.0;
  for (const StatePoints& state : evidence.states) {
    for (const ReflectorMean& mean : state.reflectors) {
      variance = std::max(variance, mean.readings * mean.covariance(*evidence.noise).trace() / 3.0);
    }
  }
  return std::sqrt(variance);
}

}  // namespace

Findings checkServo(const Evidence& evidence) {
  const Campaign& campaign = evidence.campaign;
  if (evidence.arm.cases.empty()) {
    return {notTestable("servo_change", "no postures with readings unloaded and loaded in a known geometry")};
  }
  if (!evidence.noise) {
    return {
        notTestable("servo_change", "the tracker's noise is not declared: state `tracker` in campaign.xml")};
  }
  const double lever = longestLever(evidence.arm);
  AuditCheck check;
  check.id = "servo_change";
  check.unit = "deg";
  check.value = 0.0;
  check.limit_source = fmt::format(
      "turn that carries a reflector at the longest lever, {:.2f} m, by twice its reading noise", lever);
  std::vector<const State*> unloaded(campaign.pose_ids.size(), nullptr);
  for (const State& state : campaign.states->rows) {
    if (state.step == 0) unloaded[static_cast<std::size_t>(state.pose)] = &state;
  }
  check.limit = 2.0 * readingNoise(evidence) / lever / kDegree;
  for (const State& state : campaign.states->rows) {
    const State* before = unloaded[static_cast<std::size_t>(state.pose)];
    if (before == nullptr) continue;
    int joint = 0;
    const double change = (state.q - before->q).cwiseAbs().maxCoeff(&joint) / kDegree;
    if (change <= *check.value) continue;
    check.value = change;
    check.where = rowName(campaign.states->file, state.line);
    check.message = fmt::format("joint {}'s reported angle changes most, at pose {}, step {}", joint + 1,
                                poseName(campaign, state.pose), state.step);
  }
  if (*check.value == 0.0) check.message = "no reported angle changes under load";
  if (*check.value <= *check.limit) return {check};
  check.verdict = AuditVerdict::warn;
  check.message += ": the servo gives way, and identification counts that as stiffness of the closed loop";
  return {check};
}

}  // namespace stiffscope
