#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/identification/estimate.h"
#include "core/identification/identify.h"
#include "reports/text/text.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/transmission_words.h"

namespace stiffscope::reports {

namespace {

std::string gearCell(const identification::StiffnessEstimate& gears, int joint, const StiffnessUnit& unit) {
  const double expanded = identification::expandedUncertainty(gears, joint) / unit.size;
  return fmt::format("{:.4f} +-{}", gears.stiffness(joint) / unit.size,
                     std::isfinite(expanded) ? fmt::format("{:.4f}", expanded) : "?");
}

std::string structureCell(const identification::GearAndStructure& apart, const StiffnessUnit& unit) {
  const identification::CoverageInterval interval = identification::stiffnessInterval(apart.interval);
  if (!std::isfinite(interval.low)) return "not seen";
  if (!std::isfinite(interval.high)) return fmt::format("above {:.4f}", interval.low / unit.size);
  return fmt::format("{:.4f} to {:.4f}", interval.low / unit.size, interval.high / unit.size);
}

}  // namespace

std::string transmissionText(const identification::Identification& result,
                             const std::vector<identification::Method>& methods) {
  const identification::Transmission& transmission = *result.transmission;
  const StiffnessUnit unit = stiffnessUnit(transmission);
  std::string text =
      fmt::format("\nGears by their two encoders, without the tracker, {} with U (coverage 95 %)\n", unit.text);
  const auto out = std::back_inserter(text);
  if (transmission.measured()) {
    const auto method = std::find_if(methods.rbegin(), methods.rend(),
                                     [&](identification::Method which) { return result.of(which).available; });
    const bool tracked = method != methods.rend();
    fmt::format_to(out, "  {:<4}{:>20}{:>8}{:>11}", "", "gear", "states", "held");
    if (tracked) {
      fmt::format_to(out, "{:>24}{:>14}  gear of both", "structure (" + std::string(namesOf(*method).brief) + ")", "");
    }
    fmt::format_to(out, "\n");
    for (int joint = 0; joint < transmission.estimate.joints(); ++joint) {
      const identification::GearTorsion& gear = transmission.joints[static_cast<std::size_t>(joint)];
      if (!gear.measured) continue;
      fmt::format_to(out, "  k{:<3}{:>20}{:>8}{:>11}", joint + 1, gearCell(transmission.estimate, joint, unit),
                     gear.states, wordsOf(gear.held));
      const auto apart =
          tracked ? identification::gearAndStructure(transmission, result.of(*method).estimate, joint) : std::nullopt;
      if (apart) {
        fmt::format_to(out, "{:>24}{:>14}{:>9.0f} %\n       {}", structureCell(*apart, unit),
                       apart->in_series ? "in series" : "", 100.0 * apart->gear_share, wordsOf(apart->agreement));
      }
      fmt::format_to(out, "\n");
    }
  }
  for (const std::string& note : transmissionNotes(transmission)) fmt::format_to(out, "  {}\n", wrapped(note, 4));
  return text;
}

}  // namespace stiffscope::reports
