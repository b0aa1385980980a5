#include "core/identification/warnings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/identification/identification.h"
#include "core/identification/known_stiffness.h"
#include "core/identification/remarks.h"

namespace stiffscope::identification {

std::optional<ApparentStiffness> apparentStiffness(const std::vector<LoadCase>& cases) {
  double forces = 0.0, moves = 0.0;
  std::size_t reflectors = 0;
  for (const LoadCase& load_case : cases) {
    forces += load_case.wrench.force.squaredNorm();
    for (const TargetMove& move : load_case.targets) moves += move.displacement().squaredNorm();
    reflectors += load_case.targets.size();
  }
  if (!(forces > 0.0) || !(moves > 0.0)) return std::nullopt;
  return ApparentStiffness{std::sqrt(forces / static_cast<double>(cases.size())),
                           std::sqrt(moves / static_cast<double>(reflectors))};
}

Remark implausibleLoad(const ApparentStiffness& apparent) {
  if (apparent.value() >= kSoftArm && apparent.value() <= kStiffArm) return {};
  return Remark(RemarkId::implausible_load, apparent.force, apparent.displacement);
}

namespace {

constexpr double kAboveNoise = 3.0;
constexpr double kMostNoise = 0.5;

bool hasPositive(const StiffnessEstimate& estimate) {
  for (int joint = 0; joint < estimate.joints(); ++joint) {
    if (estimate.identifiable[static_cast<std::size_t>(joint)] && estimate.compliance[joint] > 0.0) return true;
  }
  return false;
}

Remark residualWarning(const Identification& result, const MethodResult& method) {
  if (!result.noise || method.estimate.sigma < kAboveNoise * result.noise->per_coordinate) return {};
  return Remark(RemarkId::residual_above_noise, method.estimate.sigma, result.noise->per_coordinate);
}

void addSweepWarnings(const frames::Frames& frames, std::vector<Remark>& cautions) {
  for (std::size_t i = 0; i < frames.axes.size(); ++i) {
    const metrology::AxisFit& fit = frames.axes[i].fit;
    if (!frames.axes[i].measured || fit.chi2_per_dof < kAboveNoise * kAboveNoise) continue;
    cautions.push_back(Remark(RemarkId::sweep_above_noise, i + 1, fit.rms, std::sqrt(fit.chi2_per_dof)));
  }
}

}  // namespace

Remark outlyingWarning(const campaign::Campaign& campaign, const std::vector<OutlyingPosture>& outlying,
                       bool left_out) {
  if (outlying.empty()) return {};
  std::vector<std::string> postures;
  std::vector<double> left, others;
  for (const OutlyingPosture& one : outlying) {
    postures.push_back(campaign.pose_ids[static_cast<std::size_t>(one.posture)]);
    left.push_back(one.rms);
    others.push_back(one.others);
  }
  return Remark(RemarkId::outlying_postures, postures, left, others, left_out);
}

Remark outlyingWarning(const campaign::Campaign& campaign, const Identification& result) {
  return outlyingWarning(campaign, result.outlying, result.robust);
}

std::vector<Remark> warningsOf(const campaign::Campaign& campaign, const Identification& result) {
  std::vector<Remark> cautions;
  const auto add = [&](Remark remark) {
    if (!remark.empty()) cautions.push_back(std::move(remark));
  };
  const MethodResult& best = result.of(bestMethod(result));
  const MethodResult* method = best.available ? &best : nullptr;
  if (result.calibration.done && result.calibration.rms_before > kMissedGeometry) {
    add(Remark(RemarkId::geometry_missed, result.calibration.rms_before));
  }
  if (const auto apparent = apparentStiffness(result.cases)) add(implausibleLoad(*apparent));
  if (method != nullptr) {
    if (!hasPositive(method->estimate)) add(Remark(RemarkId::all_negative));
    add(residualWarning(result, *method));
    for (Remark& remark : contradictedKnown(campaign.known_stiffness, method->estimate)) add(std::move(remark));
    if (!method->estimate.covariance.allFinite()) add(Remark(RemarkId::too_few_postures, result.cases.size()));
  }
  add(outlyingWarning(campaign, result));
  if (result.noise && result.noise->at_targets > kMostNoise) add(Remark(RemarkId::mostly_noise));
  constexpr double kFelt = 1e-6;  // m; of less nothing can be wrong that a tracker reads
  if (result.frames.sag_removed && result.frames.largest_sag >= kFelt)
    add(Remark(RemarkId::sag_in_sweeps, result.frames.largest_sag));
  if (result.cases.empty() && result.frames.arm.points_placed && !result.frames.sag_removed &&
      !result.frames.sag_in_uncertainty)
    add(Remark(RemarkId::sag_left_in));
  addSweepWarnings(result.frames, cautions);
  return cautions;
}

bool anyUsable(const Identification& result, const std::vector<Method>& methods) {
  return std::any_of(methods.begin(), methods.end(), [&](Method which) {
    return result.of(which).available && hasPositive(result.of(which).estimate);
  });
}

}  // namespace stiffscope::identification
