#include <algorithm>
#include <cmath>

#include "core/audit/chance.h"
#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/rows.h"
#include "core/identification/settled_frames.h"

namespace stiffscope {

namespace {

using namespace audit_limits;

/// Radial residuals of the wrist sweep, one a row: as measured, and as the swept axes, which do not quite
/// meet, would have them. NaN for a reflector without a sphere.
struct SphereResiduals {
  std::vector<double> measured, modelled;
};

/// |point - centre| less the mean of its reflector.
std::vector<double> radialResiduals(const WristSweep& sweep, const std::vector<Eigen::Vector3d>& points,
                                    const Eigen::Vector3d& centre, std::size_t targets) {
  std::vector<double> sums(targets, 0.0), counts(targets, 0.0), residuals;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto k = static_cast<std::size_t>(sweep.rows[i].target);
    residuals.push_back((points[i] - centre).norm());
    sums[k] += residuals.back();
    counts[k] += 1.0;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto k = static_cast<std::size_t>(sweep.rows[i].target);
    residuals[i] -= sums[k] / counts[k];
  }
  return residuals;
}

SphereResiduals residualsOf(const Evidence& evidence) {
  const WristSweep& sweep = *evidence.campaign.wrist_sweep;
  const Frames& frames = evidence.frames;
  const std::size_t targets = evidence.campaign.targets.size();
  std::vector<Eigen::Vector3d> measured, modelled;
  std::vector<SpherePoints> spheres(targets);
  for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
    const auto k = static_cast<std::size_t>(sweep.rows[i].target);
    measured.push_back(frames.arm.r0_from_points * evidence.rigid.wrist_sweep[i]);
    const Eigen::Vector3d at_zero = frames.targets_in_r0_at_zero[k].value_or(Eigen::Vector3d::Zero());
    modelled.push_back(postureAt(frames.arm.arm, sweep.rows[i].q).motion[6] * at_zero);
    spheres[k].points.push_back(modelled.back());
  }
  std::erase_if(spheres, [](const SpherePoints& sphere) { return sphere.points.size() < 4; });
  const SphereFit model = fitSpheres(spheres);
  return {
      radialResiduals(sweep, measured, frames.wrist.centre_in_r0, targets),
      radialResiduals(sweep, modelled, model.determined ? model.centre : frames.wrist.centre_in_r0, targets)};
}

AuditCheck sphereCheck(const Evidence& evidence) {
  const WristCentre& wrist = evidence.frames.wrist;
  const WristSweep& sweep = *evidence.campaign.wrist_sweep;
  const SphereResiduals residuals = residualsOf(evidence);
  const double of_axes = wrist.miss_45_sd * wrist.miss_45_sd + wrist.miss_56_sd * wrist.miss_56_sd;
  double chi2 = 0.0, squares = 0.0, farthest = -1.0;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
    const Eigen::Vector3d point = evidence.frames.arm.r0_from_points * evidence.rigid.wrist_sweep[i];
    const Eigen::Vector3d radial =
        evidence.frames.arm.r0_from_points.linear().transpose() * (point - wrist.centre_in_r0).normalized();
    const double variance = radial.dot(evidence.noise->covarianceAt(sweep.rows[i].point) * radial) + of_axes;
    const double left = residuals.measured[i] - residuals.modelled[i];
    chi2 += left * left / variance;
    squares += left * left;
    if (std::abs(left) > farthest) farthest = std::abs(left), worst = sweep.rows[i].line;
  }
  const int dof = wrist.spheres.degrees_of_freedom;
  AuditCheck check;
  check.id = "wrist_sphere";
  check.value = std::sqrt(chi2 / dof);
  check.limit = std::sqrt(chiSquareLimit(kLevel, dof) / dof);
  check.unit = "of expected sd";
  check.limit_source =
      byChance(fmt::format("chi-square of {} degrees of freedom, the axes' uncertainty included", dof));
  check.message = fmt::format(
      "radial residuals of {:.1f} um rms, of which the axes' missing each other leaves {:.1f} um, "
      "{:.2f} of what is expected",
      1e6 * wrist.spheres.rms, 1e6 * std::sqrt(squares / dof), *check.value);
  if (*check.value <= *check.limit) return check;
  check.verdict = AuditVerdict::warn;
  check.where = rowName(sweep.file, worst);
  check.message += fmt::format("; farthest {}: a wrong reading, or the own weight bends more than the joints",
                               check.where);
  return check;
}

/// Share of P_wrist's displacement that turning in joints 4-6 puts there; empty without loads.
std::optional<double> leakOf(const Evidence& evidence) {
  LoadedArm arm = evidence.arm;
  if (arm.wrist.empty()) return std::nullopt;
  Vector6d wrist_only = sagCompliance(evidence.campaign, {}, arm);
  wrist_only.head<3>().setZero();
  double leak = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < arm.cases.size(); ++i) {
    const Eigen::Vector3d centre =
        arm.cases[i].posture.motion[3] * evidence.frames.wrist.centre_at_zero_in_r0;
    leak += (pointRows(arm.geometry, arm.cases[i], centre, arm.torques[i]) * wrist_only).norm();
    whole += arm.wrist[i].displacement().norm();
  }
  if (!(whole > 0.0) || !(leak > 0.0)) return std::nullopt;
  return leak / whole;
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
  const double bearable = leak ? *check.value * kWristLeak / *leak : 1e3 * TrustLimits().position;
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
  const WristCentre& wrist = evidence.frames.wrist;
  Findings findings;
  if (!wrist.measured) {
    findings.push_back(notTestable("wrist_sphere", wrist.reason));
  } else if (!evidence.noise) {
    findings.push_back(notTestable("wrist_sphere", "the tracker's noise is not declared: state `tracker`"));
  } else {
    findings.push_back(sphereCheck(evidence));
  }
  const auto& axes = evidence.frames.axes;
  if (axes[3].measured && axes[4].measured && axes[5].measured) {
    findings.push_back(missCheck(evidence));
  } else {
    findings.push_back(notTestable("wrist_axes_meet", "axes 4, 5 and 6 are not all measured: sweep each"));
  }
  return findings;
}

}  // namespace stiffscope
