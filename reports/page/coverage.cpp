#include "reports/page/coverage.h"

#include <cmath>

#include "core/audit/chance.h"
#include "core/identification/stiffness_interval.h"

namespace stiffscope::page {

Coverage coverageOf(const StiffnessEstimate& estimate, int joint) {
  const double dof = estimate.dof(joint);
  if (!(dof > 0.0) || !std::isfinite(estimate.covariance(joint, joint))) return {std::nan(""), 0.0};
  return {studentLimit(1.0 - kStatedCoverage, dof), dof};
}

}  // namespace stiffscope::page
