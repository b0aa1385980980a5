#include <fmt/format.h>

#include "core/audit/checks.h"
#include "core/audit/forces_stand_out.h"
#include "core/identification/apparent_stiffness.h"
#include "core/input/units.h"

namespace stiffscope {

Findings checkLoadSize(const Evidence& evidence) {
  const auto apparent = apparentStiffness(evidence.arm.cases);
  if (!apparent) return {notTestable("load_size", "no displacement under a force that can be brought into the robot's frame")};
  const double value = apparent->value();
  const std::string found = implausibleLoad(*apparent);
  AuditCheck check;
  check.id = "load_size";
  check.value = value * kMillimetre;
  check.limit = (value > kStiffArm ? kStiffArm : kSoftArm) * kMillimetre;
  check.unit = "N/mm";
  check.limit_source = fmt::format(
      "force over displacement of six-axis arms: at least {:.0f} N/mm, half of what light collaborative arms "
      "give, and at "
      "most {:.0f} N/mm, which is that of machine tools",
      kSoftArm * kMillimetre, kStiffArm * kMillimetre);
  check.message = found.empty() ? fmt::format("{:.4g} N rms move the reflectors by {:.3g} mm rms",
                                              apparent->force, apparent->displacement / kMillimetre)
                                : found;
  if (found.empty()) return {check};
  check.impossible =
      (value < kSofterThanAnyArm || value > kStifferThanAnyArm) && forcesStandOut(evidence.campaign);
  check.verdict = check.impossible ? AuditVerdict::fail : AuditVerdict::warn;
  return {check};
}

}  // namespace stiffscope
