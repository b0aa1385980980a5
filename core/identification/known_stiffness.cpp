#include "core/identification/known_stiffness.h"

#include <cmath>

#include "core/identification/remarks.h"
#include "core/numerics/distributions.h"

namespace stiffscope::identification {

namespace {

/// Standard uncertainty of c = 1/k.
double complianceSd(const campaign::KnownStiffness& known) { return known.sd / (known.stiffness * known.stiffness); }

}  // namespace

std::vector<campaign::KnownStiffness> completeByKnown(const std::vector<campaign::KnownStiffness>& known,
                                                      StiffnessEstimate& estimate) {
  std::vector<campaign::KnownStiffness> used;
  for (const campaign::KnownStiffness& one : known) {
    const auto joint = static_cast<std::size_t>(one.joint);
    if (estimate.identifiable[joint]) continue;
    estimate.identifiable[joint] = true;
    estimate.compliance[one.joint] = 1.0 / one.stiffness;
    estimate.covariance.row(one.joint).setZero();
    estimate.covariance.col(one.joint).setZero();
    estimate.covariance(one.joint, one.joint) = complianceSd(one) * complianceSd(one);
    if (!estimate.stated.empty()) {
      const double reach = numerics::normalLimit(1.0 - kStatedCoverage) * complianceSd(one);
      estimate.stated[joint] = {estimate.compliance[one.joint] - reach, estimate.compliance[one.joint] + reach};
    }
    used.push_back(one);
  }
  return used;
}

std::vector<Remark> contradictedKnown(const std::vector<campaign::KnownStiffness>& known,
                                      const StiffnessEstimate& estimate) {
  std::vector<Remark> remarks;
  for (const campaign::KnownStiffness& one : known) {
    if (!estimate.identifiable[static_cast<std::size_t>(one.joint)]) continue;
    const double own = estimate.compliance[one.joint], other = 1.0 / one.stiffness;
    const CoverageInterval interval = complianceInterval(estimate, one.joint);
    const double reach = other > own ? interval.high - own : own - interval.low;
    const double reach_of_other = numerics::normalLimit(1.0 - kStatedCoverage) * complianceSd(one);
    if (!(std::abs(other - own) > std::hypot(reach, reach_of_other))) continue;
    remarks.emplace_back(RemarkId::known_stiffness_contradicted, one.joint + 1, one.stiffness, one.sd, one.source,
                         1.0 / own, stiffnessInterval(interval).low, stiffnessInterval(interval).high);
  }
  return remarks;
}

}  // namespace stiffscope::identification
