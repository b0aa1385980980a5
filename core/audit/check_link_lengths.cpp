#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/identification/cautions.h"
#include "core/input/units.h"

namespace stiffscope {

Findings checkLinkLengths(const Evidence& evidence) {
  AuditCheck check;
  check.id = "link_lengths";
  check.unit = "mm";
  double farthest = -1.0;
  std::size_t at = 0;
  const auto& links = evidence.frames.links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!links[i].distance_sd) continue;
    const double off = std::abs(links[i].distance - links[i].nominal_distance);
    if (off > farthest) farthest = off, at = i;
  }
  if (farthest < 0.0) return {notTestable("link_lengths", "no two neighbouring axes with circle sweeps")};
  const LinkGeometry& link = links[at];
  check.value = farthest / kMillimetre;
  // A short arc may leave a distance open by more than machines differ.
  constexpr double kByChance = 5.0;
  check.limit = std::max(kMissedGeometry, kByChance * *link.distance_sd) / kMillimetre;
  check.limit_source =
      "20 mm, where machines are built to a few; or, where that is larger, five standard uncertainties";
  check.where = fmt::format("axes {} and {}", at + 1, at + 2);
  check.message = fmt::format("axes {} and {} stand {:.3f} mm apart, {:.3f} mm in the URDF", at + 1, at + 2,
                              link.distance / kMillimetre, link.nominal_distance / kMillimetre);
  if (*check.value <= *check.limit) return {check};
  check.verdict = AuditVerdict::fail;
  check.impossible = true;
  check.message += ": points or angles of the sweeps are in another unit, or the URDF is another machine's";
  return {check};
}

}  // namespace stiffscope
