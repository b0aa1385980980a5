#include "core/identification/apparent_stiffness.h"

#include <fmt/format.h>

#include <cmath>

#include "core/input/units.h"

namespace stiffscope {

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
      apparent.force, apparent.displacement / kMillimetre, value * kMillimetre, kSoftArm * kMillimetre,
      kStiffArm * kMillimetre, beyond_any ? "" : "perhaps ",
      soft ? "forces (kN for N) or lengths (um for mm)" : "forces (mN for N) or lengths (m for mm)");
}

}  // namespace stiffscope
