#include "core/identification/warnings.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/identification/identification.h"
#include "core/io/units.h"

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

std::string implausibleLoad(const ApparentStiffness& apparent) {
  const double value = apparent.value();
  if (value >= kSoftArm && value <= kStiffArm) return {};
  const bool soft = value < kSoftArm;
  const bool beyond_any = value < kSofterThanAnyArm || value > kStifferThanAnyArm;
  return fmt::format(
      "{:.4g} N rms move the reflectors by {:.4g} mm rms, {:.2g} N/mm, and six-axis arms give from about "
      "{:.0f} to {:.0f} N/mm: {}{} "
      "in another unit",
      apparent.force, apparent.displacement / io::kMillimetre, value * io::kMillimetre, kSoftArm * io::kMillimetre,
      kStiffArm * io::kMillimetre, beyond_any ? "" : "perhaps ",
      soft ? "forces (kN for N) or lengths (um for mm)" : "forces (mN for N) or lengths (m for mm)");
}

namespace {

constexpr double kAboveNoise = 3.0;
constexpr double kMostNoise = 0.5;

bool hasPositive(const StiffnessEstimate& estimate) {
  for (int joint = 0; joint < 6; ++joint) {
    if (estimate.identifiable[static_cast<std::size_t>(joint)] && estimate.compliance[joint] > 0.0) return true;
  }
  return false;
}

std::string residualWarning(const Identification& result, const MethodResult& method) {
  if (!result.noise || method.estimate.sigma < kAboveNoise * result.noise->per_coordinate) return {};
  return fmt::format(
      "the residual of {:.0f} µm per coordinate is {:.0f} times the {:.1f} µm of the tracker's noise: something other "
      "than "
      "joint springs is in the data, and the stated uncertainties hold it only as far as it scatters between postures",
      method.estimate.sigma / io::kMicrometre, method.estimate.sigma / result.noise->per_coordinate,
      result.noise->per_coordinate / io::kMicrometre);
}

/// Always said, whether they are left out or not.
std::string outlyingWarning(const campaign::Campaign& campaign, const Identification& result) {
  if (result.outlying.empty()) return {};
  std::string postures;
  for (const OutlyingPosture& one : result.outlying) {
    postures += fmt::format("{}{} ({:.0f} µm per coordinate against {:.0f} µm of the others)",
                            postures.empty() ? "" : ", ", campaign.pose_ids[static_cast<std::size_t>(one.posture)],
                            one.rms / io::kMicrometre, one.others / io::kMicrometre);
  }
  return fmt::format("outlying posture{}: {}: the springs of the other postures do not explain {}; {}",
                     result.outlying.size() == 1 ? "" : "s", postures, result.outlying.size() == 1 ? "it" : "them",
                     result.robust ? "left out as asked" : "used nevertheless; `identify --robust` leaves out");
}

void addSweepWarnings(const frames::Frames& frames, std::vector<std::string>& cautions) {
  for (std::size_t i = 0; i < frames.axes.size(); ++i) {
    const metrology::AxisFit& fit = frames.axes[i].fit;
    if (!frames.axes[i].measured || fit.chi2_per_dof < kAboveNoise * kAboveNoise) continue;
    cautions.push_back(fmt::format(
        "the circles of axis {} leave {:.0f} µm, {:.0f} times the tracker's noise: the axis bent during its sweep or a "
        "reading is wrong, and its uncertainty is of scatter only",
        i + 1, fit.rms / io::kMicrometre, std::sqrt(fit.chi2_per_dof)));
  }
}

}  // namespace

std::vector<std::string> warningsOf(const campaign::Campaign& campaign, const Identification& result) {
  std::vector<std::string> cautions;
  const MethodResult& best = result.of(bestMethod(result));
  const MethodResult* method = best.available ? &best : nullptr;
  if (result.calibration.done && result.calibration.rms_before > kMissedGeometry) {
    cautions.push_back(fmt::format(
        "the unloaded reflectors stand {:.0f} mm rms from where sweeps and joint angles put them: units, angles or the "
        "tracker's place are wrong in one of the tables",
        result.calibration.rms_before / io::kMillimetre));
  }
  if (const auto apparent = apparentStiffness(result.cases)) {
    if (std::string text = implausibleLoad(*apparent); !text.empty()) cautions.push_back(std::move(text));
  }
  if (method != nullptr) {
    if (!hasPositive(method->estimate)) {
      cautions.push_back(
          "every stiffness is negative: the wrench may be that of the robot on the load, not of the load on "
          "the robot");
    }
    if (std::string text = residualWarning(result, *method); !text.empty()) cautions.push_back(std::move(text));
    if (!method->estimate.covariance.allFinite()) {
      cautions.push_back(fmt::format("{} posture{} too few to state uncertainties from scatter", result.cases.size(),
                                     result.cases.size() == 1 ? " is" : "s are"));
    }
  }
  if (std::string text = outlyingWarning(campaign, result); !text.empty()) cautions.push_back(std::move(text));
  if (result.noise && result.noise->at_targets > kMostNoise) {
    cautions.push_back("the tracker's noise is more than half of the deflection: this load step hardly moves the arm");
  }
  if (result.frames.sag_removed) {
    cautions.push_back(
        fmt::format("axes and lengths stand on sweeps from which up to {:.1f} mm of the arm's own sag was taken off by "
                    "the identified "
                    "stiffnesses; what those get wrong of it is not in the stated uncertainties",
                    result.frames.largest_sag / io::kMillimetre));
  }
  addSweepWarnings(result.frames, cautions);
  return cautions;
}

bool anyUsable(const Identification& result, const std::vector<Method>& methods) {
  return std::any_of(methods.begin(), methods.end(), [&](Method which) {
    return result.of(which).available && hasPositive(result.of(which).estimate);
  });
}

}  // namespace stiffscope::identification
