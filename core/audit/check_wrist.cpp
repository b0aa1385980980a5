#include <algorithm>
#include <cmath>

#include "core/audit/chance.h"
#include "core/audit/checks.h"
#include "core/audit/finding.h"
#include "core/audit/rows.h"
#include "core/audit/wrist_residuals.h"
#include "core/identification/settled_frames.h"
#include "core/identification/wrist_leak.h"

namespace stiffscope {

namespace {

AuditCheck sphereCheck(const Evidence& evidence) {
  const WristResiduals left = wristResiduals(evidence);
  AuditCheck check;
  check.id = "wrist_sphere";
  if (left.dof <= 0) return notTestable(check.id, "too few readings: more than centre and radii take");
  check.value = std::sqrt(left.chi2 / left.dof);
  check.limit = std::sqrt(chiSquareLimit(kLevel, left.dof) / left.dof);
  check.unit = "of noise sd";
  check.limit_source = byChance(
      fmt::format("chi-square of {} degrees of freedom, axes 4-6 held by their own sweeps", left.dof));
  check.message = fmt::format(
      "radial residuals of {:.1f} um rms, of which the axes' missing each other leaves {:.1f} um, "
      "{:.2f} of the noise",
      1e6 * evidence.frames.wrist.spheres.rms, 1e6 * left.rms, *check.value);
  if (*check.value <= *check.limit) return check;
  check.verdict = AuditVerdict::warn;
  check.where = rowName(evidence.campaign.wrist_sweep->file, left.worst);
  check.message += fmt::format(
      "; farthest {}: a wrong reading, or the own weight bends more than the joints (bearings, links)",
      check.where);
  return check;
}

/// Share of P_wrist's displacement that turning in joints 4-6 puts there; empty without loads, or where the
/// axes meet exactly.
std::optional<double> leakOf(const Evidence& evidence) {
  LoadedArm arm = evidence.arm;
  if (arm.wrist.empty()) return std::nullopt;
  const Vector6d compliance = sagCompliance(evidence.campaign, {}, arm);
  const double leak = wristLeak(arm, evidence.frames.wrist.centre_at_zero_in_r0, compliance);
  return leak > 0.0 ? std::optional(leak) : std::nullopt;
}

AuditCheck missCheck(const Evidence& evidence) {
  const WristCentre& wrist = evidence.frames.wrist;
  const std::optional<double> leak = leakOf(evidence);
  AuditCheck check;
  check.id = "wrist_axes_meet";
  check.unit = "mm";
  const bool first = wrist.miss_45 >= wrist.miss_56;
  const double sd = first ? wrist.miss_45_sd : wrist.miss_56_sd;
  check.value = 1e3 * std::max(wrist.miss_45, wrist.miss_56);
  const double bearable = leak ? *check.value * kWristLeakBorne / *leak : 1e3 * TrustLimits().position;
  check.limit = std::max(bearable, 1e3 * normalLimit(kLevel / 2.0) * sd);
  check.where = first ? "axes 4 and 5" : "axes 5 and 6";
  check.limit_source =
      leak ? "the miss at which joints 4-6 would put 2 % into P_wrist's displacement: what decoupling bears"
           : "how far identification trusts places (0.2 mm), or what the sweeps' uncertainty would show";
  check.message = fmt::format(
      "axes 4 and 5 miss by {:.3f} +- {:.3f} mm, axes 5 and 6 by {:.3f} +- {:.3f} mm{}", 1e3 * wrist.miss_45,
      1e3 * wrist.miss_45_sd, 1e3 * wrist.miss_56, 1e3 * wrist.miss_56_sd,
      leak ? fmt::format(": joints 4-6 put {:.2f} % into P_wrist's displacement", 100.0 * *leak) : "");
  if (*check.value <= *check.limit) return check;
  check.verdict = AuditVerdict::warn;
  check.message += "; Decoupled Partial Pose takes them to meet in one point";
  return check;
}

}  // namespace

Findings checkWrist(const Evidence& evidence) {
  const char* const kNotSwept = "axes 4, 5 and 6 are not all measured: sweep each";
  const WristCentre& wrist = evidence.frames.wrist;
  const auto& axes = evidence.frames.axes;
  const bool swept = axes[3].measured && axes[4].measured && axes[5].measured;
  Findings findings;
  if (!wrist.measured) {
    findings.push_back(notTestable("wrist_sphere", wrist.reason));
  } else if (!swept) {
    findings.push_back(notTestable("wrist_sphere", kNotSwept));
  } else if (!evidence.noise) {
    findings.push_back(notTestable("wrist_sphere", "the tracker's noise is not declared: state `tracker`"));
  } else {
    findings.push_back(sphereCheck(evidence));
  }
  if (swept) {
    findings.push_back(missCheck(evidence));
  } else {
    findings.push_back(notTestable("wrist_axes_meet", kNotSwept));
  }
  return findings;
}

}  // namespace stiffscope
