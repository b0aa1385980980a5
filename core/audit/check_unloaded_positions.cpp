#include <algorithm>
#include <cmath>

#include "core/audit/chance.h"
#include "core/audit/checks.h"
#include "core/audit/finding.h"
#include "core/audit/limits.h"
#include "core/audit/rows.h"
#include "core/identification/cautions.h"
#include "core/identification/identifiability.h"
#include "core/input/units.h"

namespace stiffscope {

namespace {

using namespace audit_limits;

/// Geometry errors put more than noise into the positions; the shift must stand out of those too.
double misfit(const AbsoluteFit& fit) { return std::max(1.0, fit.chi2 / fit.dof); }

AuditCheck frameCheck(const AbsoluteFit& fit) {
  AuditCheck check;
  check.id = "frame_moved";
  const double ratio = fit.shift_chi2 / misfit(fit), by_chance = chiSquareLimit(kLevel, 6.0);
  const Eigen::Vector3d displacement = fit.shift.tail<3>();
  // The shift where the arm is read, or where it stands (R0's origin), whichever is larger.
  const double at_base = (displacement - fit.shift.head<3>().cross(fit.centre)).norm();
  check.value = 1e3 * std::max(displacement.norm(), at_base);
  check.limit =
      std::max(1e3 * TrustLimits().position, ratio > 0.0 ? *check.value * std::sqrt(by_chance / ratio) : 0.0);
  check.unit = "mm";
  check.limit_source = "how far identification trusts places (0.2 mm); or, where that is larger, " +
                       byChance("chi-square of a rigid shift, six degrees of freedom, over that of the rest");
  check.message = fmt::format(
      "loading against sweeps: shift of ({:.3f}, {:.3f}, {:.3f}) mm in R0 at the arm and turn of "
      "{:.0f} urad",
      1e3 * displacement.x(), 1e3 * displacement.y(), 1e3 * displacement.z(),
      1e6 * fit.shift.head<3>().norm());
  // A shift that leaves most of the misfit goes along with another fault (geometry, sag) and is not its
  // cause.
  const double explained = fit.shift_chi2 / (fit.shift_chi2 + fit.chi2);
  check.message +=
      fmt::format(", which explains {:.0f} % of the misfit of the unloaded positions", 100.0 * explained);
  if (*check.value <= *check.limit || explained < kExplains) return check;
  check.verdict = *check.value > 2.0 * *check.limit ? AuditVerdict::fail : AuditVerdict::warn;
  check.where = "loading";
  check.message += ": tracker or robot moved between sweeps and loading";
  return check;
}

AuditCheck positionsCheck(const AbsoluteFit& fit) {
  AuditCheck check;
  check.id = "unloaded_positions";
  const double by_chance = fit.rms_after * std::sqrt(chiSquareLimit(kLevel, fit.dof) / fit.chi2);
  check.value = 1e3 * fit.rms_after;
  check.limit = 1e3 * std::max(kShareOfTolerance * TrustLimits().position, by_chance);
  check.unit = "mm";
  check.limit_source =
      "a third of the 0.2 mm to which identification trusts places; or, where that is larger, " +
      byChance(fmt::format("chi-square of {} degrees of freedom", fit.dof));
  check.message = fmt::format(
      "{} unloaded positions miss forward kinematics with sag by {:.3f} mm rms per coordinate, "
      "{:.3f} mm once shift, reflectors, axes and sag are fitted within their uncertainties ({:.2f} "
      "of what these leave open)",
      fit.positions, 1e3 * fit.rms_before, 1e3 * fit.rms_after, std::sqrt(fit.chi2 / fit.dof));
  if (*check.value <= *check.limit) return check;
  if (fit.rms_after > kMissedGeometry) {
    check.verdict = AuditVerdict::fail;
    check.impossible = true;
    check.message +=
        "; far more than own weight leaves once it is taken off: units, angles or the tracker's place are wrong in "
        "one of the tables";
    return check;
  }
  check.verdict = AuditVerdict::warn;
  check.message +=
      "; the swept geometry does not carry over to the postures: joint zeros, gear errors, or the own weight "
      "bends more than the joints (bearings, links)";
  return check;
}

const State* unloadedState(const Campaign& campaign, int pose) {
  for (const State& state : campaign.states->rows) {
    if (state.pose == pose && state.step == 0) return &state;
  }
  return nullptr;
}

AuditCheck readBackCheck(const Evidence& evidence) {
  const AbsoluteFit& fit = evidence.absolute;
  AuditCheck check;
  check.id = "joint_read_back";
  check.limit = fit.score_limit;
  check.value = 0.0;
  check.unit = "of scatter";
  check.limit_source = byChance("Student's t by the median absolute deviation between postures");
  std::string found;
  double worst = 0.0;
  for (const PostureReadBack& posture : fit.postures) {
    check.value = std::max(*check.value, posture.score);
    // A posture whose misfit no joint angles explain has another fault, such as exchanged reflectors.
    constexpr double kMostly = 0.9;
    if (!posture.outlier || posture.explained < kMostly) continue;
    const State* state = unloadedState(evidence.campaign, posture.pose);
    const std::string row = rowName(evidence.campaign.states->file, state->line);
    if (posture.score > worst) worst = posture.score, check.where = row;
    found += fmt::format("{}{} (pose {}: joint {} stands {:.4f} deg from what is reported)",
                         found.empty() ? "" : "; ", row, poseName(evidence.campaign, posture.pose),
                         posture.joint + 1, posture.joint_correction / kDegree);
  }
  check.message = "reported joint angles agree with what the reflectors say, posture by posture";
  if (found.empty()) {
    check.value = std::min(*check.value, *check.limit);
    return check;
  }
  check.verdict = AuditVerdict::fail;
  check.message = "reported before the arm settled, or stale: " + found;
  return check;
}

}  // namespace

Findings checkUnloadedPositions(const Evidence& evidence) {
  const AbsoluteFit& fit = evidence.absolute;
  Findings findings;
  const std::string no_sag =
      "the arm's own sag is not known: state masses in the URDF, and load steps that identify stiffnesses";
  for (const char* id : {"frame_moved", "unloaded_positions"}) {
    if (!fit.done || !fit.sag_known) findings.push_back(notTestable(id, fit.done ? no_sag : fit.reason));
  }
  if (findings.empty()) findings = {frameCheck(fit), positionsCheck(fit)};
  constexpr std::size_t kToCompare =
      6;  // the median needs a majority of sound postures to tell outliers from
  if (!fit.done) {
    findings.push_back(notTestable("joint_read_back", fit.reason));
  } else if (fit.postures.size() < kToCompare) {
    findings.push_back(
        notTestable("joint_read_back", fmt::format("fewer than {} postures to compare", kToCompare)));
  } else {
    findings.push_back(readBackCheck(evidence));
  }
  return findings;
}

}  // namespace stiffscope
