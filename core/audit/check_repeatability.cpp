#include <cmath>

#include "core/audit/chance.h"
#include "core/audit/checks.h"
#include "core/audit/finding.h"
#include "core/audit/repeat_scatter.h"
#include "core/audit/rows.h"

namespace stiffscope {

namespace {

AuditCheck scatterCheck(const std::string& id, const char* direction, double chi2, int dof, double rms) {
  AuditCheck check;
  check.id = id;
  check.value = std::sqrt(chi2 / dof);
  check.limit = std::sqrt(chiSquareLimit(kLevel, dof) / dof);
  check.unit = "of declared sd";
  check.limit_source = byChance(fmt::format("chi-square of {} degrees of freedom", dof));
  if (*check.value > *check.limit) {
    check.verdict =
        *check.value * *check.value > kFailVarianceRatio ? AuditVerdict::fail : AuditVerdict::warn;
  }
  check.message =
      fmt::format("repeats scatter {} the beam by {:.1f} um (one sigma), {:.2f} of what is declared{}",
                  direction, 1e6 * rms, *check.value,
                  check.verdict == AuditVerdict::pass
                      ? ""
                      : ": every stated uncertainty is too small by as much; the other checks take the noise "
                        "as the repeats show it");
  // Repeats within seconds do not see all that a data sheet covers; less than half of it is another matter.
  constexpr double kFarBelow = 0.5;
  if (*check.value < kFarBelow) {
    check.details.push_back(
        fmt::format("repeats scatter by less than half of what is declared: one sigma of a reading is asked "
                    "for, not the maximum "
                    "permissible error of a data sheet (ISO 10360-10); checks and uncertainties are as lax "
                    "as the declaration"));
  }
  return check;
}

}  // namespace

Findings checkRepeatability(const Evidence& evidence) {
  const RepeatScatter& scatter = evidence.scatter;
  if (!scatter.tested) {
    return {notTestable("repeatability_along", scatter.reason),
            notTestable("repeatability_across", scatter.reason)};
  }
  return {
      scatterCheck("repeatability_along", "along", scatter.along_chi2, scatter.along_dof, scatter.along_rms),
      scatterCheck("repeatability_across", "across", scatter.across_chi2, scatter.across_dof,
                   scatter.across_rms)};
}

}  // namespace stiffscope
