#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/audit/chance.h"
#include "core/audit/checks.h"
#include "core/audit/forces_stand_out.h"
#include "core/audit/hook_fit.h"
#include "core/audit/finding.h"
#include "core/audit/limits.h"
#include "core/audit/rows.h"
#include "core/identification/identifiability.h"

namespace stiffscope {

namespace {

using namespace audit_limits;

const char* const kNoSigma =
    "the load cell's noise is not stated: force_sigma_n and moment_sigma_nm in campaign.xml";

AuditCheck tareCheck(const Evidence& evidence) {
  const LoadCell& cell = *evidence.campaign.load_cell;
  Vector6d sum = Vector6d::Zero();
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(cell.force_sigma), Eigen::Vector3d::Constant(cell.moment_sigma);
  double worst = 0.0;
  const State* worst_state = nullptr;
  int count = 0;
  for (const State& state : evidence.campaign.states->rows) {
    if (state.step != 0) continue;
    sum += state.wrench_in_cell;
    ++count;
    const double chi2 = state.wrench_in_cell.cwiseQuotient(sigma).squaredNorm();
    if (worst_state == nullptr || chi2 > worst) worst = chi2, worst_state = &state;
  }
  if (worst_state == nullptr) return notTestable("tare", "no unloaded states (step 0)");
  const Vector6d mean = sum / count;
  const double of_mean = count * mean.cwiseQuotient(sigma).squaredNorm();
  AuditCheck check;
  check.id = "tare";
  check.value = std::sqrt(of_mean / 6.0);
  check.limit = std::sqrt(chiSquareLimit(0.5 * kLevel, 6.0) / 6.0);
  check.unit = "of its sd";
  check.limit_source =
      byChance("chi-square of the mean unloaded reading, six components, and of each reading");
  check.message = fmt::format(
      "unloaded, the load cell shows ({:.2f}, {:.2f}, {:.2f}) N and ({:.2f}, {:.2f}, {:.2f}) Nm on average",
      mean[0], mean[1], mean[2], mean[3], mean[4], mean[5]);
  const bool one_off = worst > chiSquareLimit(0.5 * kLevel / count, 6.0);
  if (*check.value <= *check.limit && !one_off) return check;
  check.verdict = AuditVerdict::warn;
  check.where = rowName(evidence.campaign.states->file, worst_state->line);
  check.message += *check.value > *check.limit
                       ? ": not tared, or tared with something on it"
                       : fmt::format("; pose {} is {:.1f} sigma off",
                                     poseName(evidence.campaign, worst_state->pose), std::sqrt(worst / 6.0));
  return check;
}

AuditCheck gravityCheck(const Evidence& evidence) {
  const LoadedArm& arm = evidence.arm;
  if (arm.cases.empty())
    return notTestable("gravity_direction", "no postures with readings unloaded and loaded");
  const Identifiability judged =
      judgeJoints(arm.geometry, arm.cases, *evidence.campaign.load_cell, reflectorEquations(arm));
  if (!judged.load_hangs)
    return notTestable("gravity_direction", "the load does not hang: it is pulled to the side");
  const Eigen::Vector3d down = arm.geometry.weight.gravity_in_base.normalized();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double least_force = INFINITY, farthest = -1.0;
  const LoadCase* worst = nullptr;
  for (const LoadCase& load_case : arm.cases) {
    const Eigen::Vector3d force = load_case.wrench.force;
    mean += force.normalized() / static_cast<double>(arm.cases.size());
    least_force = std::min(least_force, force.norm());
    const double angle = std::atan2(force.cross(down).norm(), force.dot(down));
    if (angle > farthest) farthest = angle, worst = &load_case;
  }
  AuditCheck check;
  check.id = "gravity_direction";
  check.value = 1e3 * judged.gravity_angle_rms;
  // Two directions: the load cell's turn as identification trusts it, and what its noise adds to one reading.
  check.limit = 1e3 *
                std::hypot(TrustLimits().direction, evidence.campaign.load_cell->force_sigma / least_force) *
                std::sqrt(chiSquareLimit(kLevel, 2.0));
  check.unit = "mrad";
  check.limit_source =
      "how far identification trusts the load cell's axes (2 mrad, one sigma) and its noise; chi-square of "
      "two directions";
  check.message = fmt::format(
      "a hanging load's force lies {:.2f} mrad rms off gravity, {:.2f} mrad on average, farthest "
      "{:.2f} mrad at pose {}",
      *check.value, 1e3 * std::atan2(mean.cross(down).norm(), mean.dot(down)), 1e3 * farthest,
      poseName(evidence.campaign, worst->pose));
  if (*check.value <= *check.limit) return check;
  check.verdict = AuditVerdict::warn;
  check.where = fmt::format("pose {}", poseName(evidence.campaign, worst->pose));
  check.message += ": load cell turned against its declared axes, a rope that drags, or base_link not level";
  return check;
}

AuditCheck leverCheck(const Evidence& evidence) {
  const HookFit fit = fitHook(evidence.campaign);
  if (!fit.done) return notTestable("moment_lever", fit.reason);
  AuditCheck check;
  check.id = "moment_lever";
  check.value = std::sqrt(fit.chi2 / fit.dof);
  check.limit = std::sqrt(chiSquareLimit(0.5 * kLevel, fit.dof) / fit.dof);
  check.unit = "of its sd";
  check.limit_source =
      byChance(fmt::format("chi-square of {} degrees of freedom, and of each state", fit.dof));
  check.message = fmt::format(
      "moments are those of the force at ({:.1f}, {:.1f}, {:.1f}) mm from the cell's point, but for "
      "{:.2f} Nm rms",
      1e3 * fit.lever.x(), 1e3 * fit.lever.y(), 1e3 * fit.lever.z(), fit.rms);
  if (fit.lever.norm() > kLongestLever && forcesStandOut(evidence.campaign)) {
    check.verdict = AuditVerdict::fail;
    check.impossible = true;
    check.message += ": no tool is that long, forces (kN for N) or moments (N mm for Nm) are in another unit";
    return check;
  }
  if (*check.value <= *check.limit && fit.worst_chi2 <= fit.worst_limit) return check;
  check.verdict = fit.chi2 / fit.dof > kFailVarianceRatio ? AuditVerdict::fail : AuditVerdict::warn;
  check.where = rowName(evidence.campaign.states->file, fit.worst_line);
  check.message += fmt::format("; worst at {} (pose {}, step {})", check.where,
                               poseName(evidence.campaign, fit.worst_pose), fit.worst_step);
  if (!fit.mending_signs.empty())
    check.message += fmt::format("; with {} turned round they agree", fit.mending_signs);
  return check;
}

}  // namespace

Findings checkLoadCell(const Evidence& evidence) {
  const Campaign& campaign = evidence.campaign;
  if (!campaign.load_cell || !campaign.states) {
    Findings missing;
    for (const char* id : {"tare", "gravity_direction", "moment_lever"}) {
      missing.push_back(notTestable(id, "no load cell readings: `load_cell` and `states`"));
    }
    return missing;
  }
  const bool stated = campaign.load_cell->force_sigma > 0.0 && campaign.load_cell->moment_sigma > 0.0;
  return {stated ? tareCheck(evidence) : notTestable("tare", kNoSigma), gravityCheck(evidence),
          stated ? leverCheck(evidence) : notTestable("moment_lever", kNoSigma)};
}

}  // namespace stiffscope
